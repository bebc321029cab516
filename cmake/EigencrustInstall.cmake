# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where; find_package(eigencrust) then gives eigencrust::eigencrust, ::io and ::render.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/eigencrust)
install(TARGETS eigencrust eigencrust_io eigencrust_render EXPORT eigencrustTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT eigencrustTargets NAMESPACE eigencrust:: DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/eigencrustConfig.cmake.in
  ${PROJECT_BINARY_DIR}/eigencrustConfig.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 the interface may change with every minor version.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/eigencrustConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/eigencrustConfig.cmake ${PROJECT_BINARY_DIR}/eigencrustConfigVersion.cmake
  DESTINATION ${package_folder})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/eigencrust DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/eigencrust/examples
  PATTERN "*.sh" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/eigencrust)
