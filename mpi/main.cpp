// SPDX-License-Identifier: GPL-3.0-or-later
// The command on several machines: mpiexec -n 4 eigencrust-mpi scan.ply -o mesh.ply
#include "heap.h"
#include "process.h"
#include "ranks.h"

int main(int argc, char** argv) {
  eigencrust::cli::keep_freed_memory();
  const eigencrust::mpi::Messages messages(argc, argv);
  if (!messages.is_root()) {
    eigencrust::mpi::serve(messages);
    return 0;
  }
  eigencrust::mpi::OtherRanks others(messages);
  const int status = eigencrust::cli::run_process(argc, argv, &others);
  others.end();
  return status;
}
