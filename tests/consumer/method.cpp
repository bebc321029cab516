// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/eigencrust.h>

int main() {
  eigencrust::PointCloud cloud;
  for (int i = 0; i < 8; ++i) cloud.points.push_back({i & 1 ? 1.0 : 0, i & 2 ? 1.0 : 0, i & 4 ? 1.0 : 0});
  cloud.points.push_back({0.5, 0.5, 1.25});
  return eigencrust::reconstruct(cloud).report.mesh.closed() ? 0 : 1;
}
