# SPDX-License-Identifier: GPL-3.0-or-later
# What a shared library shows: all that the public headers declare, and nothing else. The headers themselves know
# nothing of it. While a shared library is compiled, each of them is included through a wrapper that makes its
# declarations visible; so a new one needs no care.
if(BUILD_SHARED_LIBS)
  if(EIGENCRUST_BUILD_TESTS OR EIGENCRUST_BUILD_TOOLS OR EIGENCRUST_BUILD_BENCH)
    message(FATAL_ERROR "Tests, tools and benchmarks look inside the library: with BUILD_SHARED_LIBS turn "
                        "EIGENCRUST_BUILD_TESTS, EIGENCRUST_BUILD_TOOLS and EIGENCRUST_BUILD_BENCH off")
  endif()
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/include/eigencrust/*.h)
  list(TRANSFORM headers PREPEND include/)
  # What the libraries of files and pictures, and the Python module, use of the method's.
  list(APPEND headers src/evidence/sensor_rows.h src/geometry/mesh_topology.h src/geometry/nearest.h
       src/surface/attributes.h)
  foreach(header ${headers})
    string(REGEX REPLACE "^(include|src)/" "" wrapper ${header})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/visible/${wrapper} CONTENT "#pragma once
#pragma GCC visibility push(default)
#include \"${PROJECT_SOURCE_DIR}/${header}\"
#pragma GCC visibility pop
")
  endforeach()
endif()

function(eigencrust_hide_internals target)
  if(BUILD_SHARED_LIBS)
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_include_directories(${target} BEFORE PRIVATE ${PROJECT_BINARY_DIR}/visible)
    # Templates of other libraries that were compiled in are nobody else's.
    target_link_options(${target} PRIVATE -Wl,--exclude-libs,ALL -Wl,--no-undefined)
  endif()
endfunction()
