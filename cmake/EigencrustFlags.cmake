# SPDX-License-Identifier: GPL-3.0-or-later
# Warnings and sanitizers for one of the project's own targets.
function(eigencrust_flags target)
  # Without fused multiply-add a result does not depend on which instructions the compiler picked.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  # Nobody puts functions of his own in the place of the library's, so that they may be inlined where they are called.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
  # The standard library checks each access to its containers.
  target_compile_definitions(${target} PRIVATE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
  # Warnings are for those who change the code, whose presets ask for it; they take time.
  if(EIGENCRUST_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror
      -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wcast-qual -Wnon-virtual-dtor)
  endif()
  if(EIGENCRUST_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${EIGENCRUST_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    # With GCC these two are a quarter of the time of compiling, in some files half. A null pointer that is followed is
    # seen by the address sanitizer; misaligned ones come from the bytes of files, so that the readers keep both.
    if(EIGENCRUST_SANITIZE MATCHES "undefined" AND NOT target STREQUAL "eigencrust_io")
      target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment)
    endif()
    target_link_options(${target} PUBLIC -fsanitize=${EIGENCRUST_SANITIZE})
  endif()
endfunction()
