// SPDX-License-Identifier: GPL-3.0-or-later
// The eigenvector of the pole graph (§3.2) by SLEPc on all ranks, beside the program's own: do they agree on every
// sign? Usage: mpiexec -n 2 eigencrust-scale-eigenvector CLOUD...
#include <slepceps.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <eigencrust/eigencrust.h>
#include <eigencrust/io.h>

#include "evidence/evidence.h"
#include "numerics/dominant_edges.h"
#include "numerics/partition.h"
#include "poles/solve.h"
#include "tetrahedra/scene.h"

namespace eigencrust {
namespace {

constexpr double tolerance = 1e-7; // of the residual over the eigenvalue
constexpr int most_steps = 5000;

void require(PetscErrorCode code) {
  if (code != 0) MPI_Abort(PETSC_COMM_WORLD, code);
}

/// D^-1/2 L D^-1/2 of the supernodes' component, and the program's own eigenvector.
struct Problem {
  BorderedMatrix laplacian;
  Vector mass;
  IterationResult own;
};

/// The graph as partition_poles() solves it; only on one rank.
Problem problem_of(const std::string& file) {
  const PointCloud cloud = read_point_cloud(file);
  const Options options;
  Report report;
  Run run(report, *default_observer());
  const Threads threads(0);
  const Context context{options, run, threads};
  const Scene scene = make_scene(cloud, context);
  const Evidence evidence = gather_evidence(cloud, scene, context);
  const PoleSolution solved = solve_poles(scene, evidence, context);
  SignedGraph graph = merge_dominated_nodes(solved.graph.graph, threads).graph;
  const Components components = connected_components(graph);
  if (components.count > 1) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i < graph.node_count(); ++i)
      if (components.of_node[i] == 0) nodes.push_back(i);
    graph = extract_component(graph, 0, nodes);
  }
  Problem problem{signed_laplacian(std::move(graph), threads), {}, {}};
  problem.mass = full_diagonal(problem.laplacian);
  SignedMultigrid hierarchy(problem.laplacian, problem.mass, threads);
  problem.own = smallest_eigenvector(hierarchy, control_of(options.solver, {}), threads);
  return problem;
}

/// Entries come from the first rank; PETSc takes the rows where they belong.
Mat matrix_of(const Problem& problem, PetscInt size, bool has_entries) {
  Mat matrix = nullptr;
  require(MatCreate(PETSC_COMM_WORLD, &matrix));
  require(MatSetSizes(matrix, PETSC_DECIDE, PETSC_DECIDE, size, size));
  require(MatSetType(matrix, MATAIJ));
  require(MatSetUp(matrix));
  require(MatSetOption(matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  if (has_entries) {
    const BorderedMatrix& m = problem.laplacian;
    const auto n = static_cast<PetscInt>(m.interior_size());
    const auto add = [&](PetscInt i, PetscInt j, double value) {
      const double scale =
          std::sqrt(problem.mass[static_cast<std::size_t>(i)] * problem.mass[static_cast<std::size_t>(j)]);
      if (scale > 0) require(MatSetValue(matrix, i, j, value / scale, INSERT_VALUES));
    };
    for (PetscInt i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      add(i, i, m.diagonal[row]);
      for (std::uint64_t k = m.row_begin[row]; k < m.row_begin[row + 1]; ++k)
        add(i, static_cast<PetscInt>(m.column[k]), static_cast<double>(m.value[k]));
      for (std::size_t b = 0; b < m.border.size(); ++b)
        if (const double value = static_cast<double>(m.border[b][row]); value != 0) {
          add(i, n + static_cast<PetscInt>(b), value);
          add(n + static_cast<PetscInt>(b), i, value);
        }
    }
    for (std::size_t a = 0; a < m.corner.size(); ++a)
      for (std::size_t b = 0; b < m.corner.size(); ++b)
        add(n + static_cast<PetscInt>(a), n + static_cast<PetscInt>(b), m.corner[a][b]);
  }
  require(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  require(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

struct Eigenpair {
  double value = 0, error = 0;
  Vector vector; ///< on the first rank
};

/// The smallest (LOBPCG, Knyazev 2001). Options of SLEPc on the command line go before.
Eigenpair solve(Mat matrix) {
  EPS solver = nullptr;
  require(EPSCreate(PETSC_COMM_WORLD, &solver));
  require(EPSSetOperators(solver, matrix, nullptr));
  require(EPSSetProblemType(solver, EPS_HEP));
  require(EPSSetWhichEigenpairs(solver, EPS_SMALLEST_REAL));
  require(EPSSetType(solver, EPSLOBPCG));
  require(EPSSetTolerances(solver, tolerance, most_steps));
  ST transform = nullptr;
  require(EPSGetST(solver, &transform));
  require(STSetType(transform, STPRECOND));
  KSP linear = nullptr;
  require(STGetKSP(transform, &linear));
  PC preconditioner = nullptr;
  require(KSPGetPC(linear, &preconditioner));
  require(PCSetType(preconditioner, PCBJACOBI)); // incomplete factors of each rank's rows
  require(EPSSetFromOptions(solver));
  require(EPSSolve(solver));
  Vec x = nullptr, all = nullptr;
  require(MatCreateVecs(matrix, &x, nullptr));
  Eigenpair pair;
  require(EPSGetEigenpair(solver, 0, &pair.value, nullptr, x, nullptr));
  require(EPSComputeError(solver, 0, EPS_ERROR_ABSOLUTE, &pair.error));
  VecScatter to_first = nullptr;
  require(VecScatterCreateToZero(x, &to_first, &all));
  require(VecScatterBegin(to_first, x, all, INSERT_VALUES, SCATTER_FORWARD));
  require(VecScatterEnd(to_first, x, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt size = 0;
  require(VecGetLocalSize(all, &size));
  const PetscScalar* values = nullptr;
  require(VecGetArrayRead(all, &values));
  pair.vector.assign(values, values + size);
  require(VecRestoreArrayRead(all, &values));
  require(VecScatterDestroy(&to_first));
  require(VecDestroy(&all));
  require(VecDestroy(&x));
  require(EPSDestroy(&solver));
  return pair;
}

/// \return how many signs differ
std::size_t compare(const std::string& file, const Problem& problem, const Eigenpair& theirs) {
  const Vector& own = problem.own.x;
  double together = 0;
  for (std::size_t i = 0; i < own.size(); ++i) together += std::sqrt(problem.mass[i]) * own[i] * theirs.vector[i];
  std::size_t open = 0, differ = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const bool is_open = own[i] == 0 || (i < problem.own.unsettled.size() && problem.own.unsettled[i] != 0);
    open += is_open ? 1 : 0;
    if (!is_open && own[i] * theirs.vector[i] * together <= 0) ++differ;
  }
  std::printf("| %s | %zu | %zu | %zu | %.6g | %.6g | %.1e |\n", file.c_str(), own.size(), open, differ,
              problem.own.eigenvalue, theirs.value, theirs.error);
  std::fflush(stdout);
  return differ;
}

std::size_t compare_all(const std::vector<std::string>& files) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  std::size_t differ = 0;
  if (rank == 0)
    std::printf(
        "| cloud | nodes | left open | signs that differ | eigenvalue | by SLEPc | its error |\n"
        "|---|---|---|---|---|---|---|\n");
  for (const std::string& file : files) {
    Problem problem;
    if (rank == 0) problem = problem_of(file);
    PetscInt size = static_cast<PetscInt>(problem.mass.size());
    MPI_Bcast(&size, 1, MPIU_INT, 0, PETSC_COMM_WORLD);
    Mat matrix = matrix_of(problem, size, rank == 0);
    const Eigenpair theirs = solve(matrix);
    if (rank == 0) differ += compare(file, problem, theirs);
    require(MatDestroy(&matrix));
  }
  return differ;
}

} // namespace
} // namespace eigencrust

int main(int argc, char** argv) {
  std::vector<std::string> files;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) files.emplace_back(argv[i]);
  eigencrust::require(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  std::size_t differ = 0;
  try {
    differ = eigencrust::compare_all(files);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(PETSC_COMM_WORLD, 3);
  }
  SlepcFinalize();
  return differ == 0 ? 0 : 1;
}
