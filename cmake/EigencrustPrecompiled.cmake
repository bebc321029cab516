# SPDX-License-Identifier: GPL-3.0-or-later
# Headers that most files of a target include are parsed once for it. Presets for developers turn this off
# (CMAKE_DISABLE_PRECOMPILE_HEADERS), so that a missing include is seen there and compiler caches keep working.
set(eigencrust_standard_headers <algorithm> <array> <charconv> <cmath> <cstdint> <filesystem> <fstream> <functional>
    <limits> <map> <memory> <optional> <span> <string> <string_view> <vector>)

function(eigencrust_precompile target)
  target_precompile_headers(${target} PRIVATE ${eigencrust_standard_headers} ${ARGN})
  # Out of precompiled headers GCC 12 warns of what is inside std::string, which it leaves alone elsewhere.
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${target} PRIVATE -Wno-array-bounds
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
  endif()
endfunction()
