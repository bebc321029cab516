# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack` in a build with shared libraries makes a .deb with everything: command, libraries, headers, files for CMake
# and pkg-config, documentation, and the Python module if it was built. scripts/package.sh does all of it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME eigencrust)
set(CPACK_PACKAGE_CONTACT "The Eigencrust authors <eigencrust@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "watertight manifold meshes from raw point clouds")
set(CPACK_PACKAGE_DESCRIPTION
"Eigencrust turns raw point clouds, noisy, with outliers and holes and without
normals, into watertight, manifold triangle meshes by spectral labelling of
Delaunay tetrahedra.
.
This package holds the command, the libraries for C++ and C with their headers,
and the Python module.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-open3d")
if(EIGENCRUST_BUILD_PYTHON)
  # The module fits the Python it was compiled for.
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
endif()

# What Debian wants of each package: who made it under which licence, and what changed.
set(debian ${PROJECT_BINARY_DIR}/debian)
file(WRITE ${debian}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: eigencrust

Files: *
Copyright: 2026 the Eigencrust authors
License: GPL-3.0-or-later
 This program is free software under the GNU General Public License, version 3
 or later. On Debian systems its text is in /usr/share/common-licenses/GPL-3.
")
install(FILES ${debian}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
find_program(GZIP_PROGRAM gzip)
if(GZIP_PROGRAM)
  # Without name and time, so that the same source gives the same bytes.
  execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
                  OUTPUT_FILE ${debian}/changelog.gz)
  install(FILES ${debian}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
endif()

include(CPack)
