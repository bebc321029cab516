# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack` in a build with shared libraries makes a .deb with everything: command, libraries, headers, files for CMake
# and pkg-config, documentation, and the Python module if it was built. scripts/package.sh does all of it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME eigencrust)
# A packager names himself; the default is an address that reaches nobody.
set(EIGENCRUST_MAINTAINER "The Eigencrust authors <eigencrust@example.org>" CACHE STRING "Maintainer of the package")
set(CPACK_PACKAGE_CONTACT "${EIGENCRUST_MAINTAINER}")
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
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
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
if(EXISTS ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/viewer.html)
  file(APPEND ${debian}/copyright "
Files: viewer/*
Copyright: 2010-2025 three.js authors
           2026 the Eigencrust authors
License: GPL-3.0-or-later and Expat
Comment: the viewer of pages, usr/share/eigencrust/viewer.html, contains three.js.

License: Expat
 Permission is hereby granted, free of charge, to any person obtaining a copy
 of this software and associated documentation files (the \"Software\"), to deal
 in the Software without restriction, including without limitation the rights
 to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
 copies of the Software, and to permit persons to whom the Software is
 furnished to do so, subject to the following conditions:
 .
 The above copyright notice and this permission notice shall be included in
 all copies or substantial portions of the Software.
 .
 THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
 IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
 FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
 AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
 LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
 OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
 SOFTWARE.
")
endif()
install(FILES ${debian}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
# The time is SOURCE_DATE_EPOCH where that is set.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${debian}/changelog.Debian
"eigencrust (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * What changed is in changelog.gz.

 -- ${EIGENCRUST_MAINTAINER}  ${now}
")
find_program(GZIP_PROGRAM gzip)
if(GZIP_PROGRAM)
  # Without name and time, so that the same source gives the same bytes.
  execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
                  OUTPUT_FILE ${debian}/changelog.gz)
  execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${debian}/changelog.Debian OUTPUT_FILE ${debian}/changelog.Debian.gz)
  install(FILES ${debian}/changelog.gz ${debian}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
  # The manual page is made by the build and installed as it is; in the package it is compressed.
  file(WRITE ${debian}/compress.cmake
"file(GLOB pages \"\${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/${CMAKE_INSTALL_MANDIR}/man1/*.1\")
foreach(page \${pages})
  execute_process(COMMAND ${GZIP_PROGRAM} -9nf \${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
")
  set(CPACK_PRE_BUILD_SCRIPTS ${debian}/compress.cmake)
endif()

# The linker's cache knows the libraries once the package is there.
file(WRITE ${debian}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${debian}/triggers)

include(CPack)
