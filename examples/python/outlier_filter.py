# SPDX-License-Identifier: GPL-3.0-or-later
"""An outlier filter: the points that belong to the surface, with everything the file says of them.

Usage: outlier_filter.py SCAN CLEAN.ply
"""

import sys

import eigencrust

scan, clean_file = sys.argv[1:3]
cloud = eigencrust.read_point_cloud(scan)
found = eigencrust.outliers(cloud)
keep = found.inlier  # or: found.confidence > 0.9

clean = eigencrust.PointCloud(
    cloud.points[keep], attributes={name: column[keep] for name, column in cloud.attributes.items()}
)
eigencrust.write_point_cloud(clean_file, clean)
print(f"kept {len(clean):,} of {len(cloud):,} points")
