// SPDX-License-Identifier: GPL-3.0-or-later
#include "heap.h"
#include "process.h"

int main(int argc, char** argv) {
  eigencrust::cli::keep_freed_memory();
  return eigencrust::cli::run_process(argc, argv);
}
