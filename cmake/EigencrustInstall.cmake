# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where; find_package(eigencrust) then gives eigencrust::eigencrust, ::io and ::render.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/eigencrust)
install(TARGETS eigencrust eigencrust_io eigencrust_render EXPORT eigencrustTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT eigencrustTargets NAMESPACE eigencrust:: DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/eigencrustConfig.cmake.in
  ${PROJECT_BINARY_DIR}/eigencrustConfig.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 the interface may change with every minor version.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/eigencrustConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/eigencrustConfig.cmake ${PROJECT_BINARY_DIR}/eigencrustConfigVersion.cmake
  DESTINATION ${package_folder})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# pkg-config: eigencrust is the method with its C interface, eigencrust-io and -render come on top. What a static
# library leaves to whoever links it is private.
function(eigencrust_pkg_config name description library requires private)
  if(BUILD_SHARED_LIBS)
    set(requires_private)
    set(libs_private)
  else()
    set(requires_private "Requires.private: ${private}\n")
    # What has no file of pkg-config.
    set(libs_private "Libs.private: -ltbbmalloc -lstdc++ -lm\n")
  endif()
  # The prefix is found from where the file lies, so that an installation can be moved.
  file(RELATIVE_PATH up "/p/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/p")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.pc @ONLY CONTENT "prefix=\${pcfiledir}/${up}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: ${name}
Description: ${description}
Version: ${PROJECT_VERSION}
Requires: ${requires}
${requires_private}Libs: -L\${libdir} -l${library}
${libs_private}Cflags: -I\${includedir}
")
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
eigencrust_pkg_config(eigencrust "${PROJECT_DESCRIPTION}" eigencrust "" "tbb mpfr gmp")
eigencrust_pkg_config(eigencrust-io "Point clouds and meshes from and to files" eigencrust_io eigencrust
                      "zlib libcrypto pugixml tinygltf lib3MF")
eigencrust_pkg_config(eigencrust-render "Pictures of meshes and clouds" eigencrust_render eigencrust-io libpng)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/eigencrust/examples
  PATTERN "*.sh" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
include(EigencrustPackage)
