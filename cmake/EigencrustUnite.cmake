# SPDX-License-Identifier: GPL-3.0-or-later
# The files of a folder are compiled together, so that the headers that they share (CGAL, Eigen, the standard library)
# are read and their templates made once. The preset of the tests turns this off, so that a missing include is seen
# there, and presets for developers, so that a change compiles one file again.
option(EIGENCRUST_UNITE "Compile the files of a folder together" ON)
# More files than this in one folder are several groups: a core has to have something to do while another compiles.
set(eigencrust_files_together 8)

function(eigencrust_unite target)
  if(NOT EIGENCRUST_UNITE)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(SORT sources)
  set(last_folder "")
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    if(NOT folder STREQUAL last_folder)
      set(last_folder ${folder})
      set(count 0)
    endif()
    cmake_path(GET folder FILENAME name)
    math(EXPR part "${count} / ${eigencrust_files_together}")
    math(EXPR count "${count} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${name}_${part}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # A class in a file's unnamed namespace that another class of that file holds: GCC takes the joined file for a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
