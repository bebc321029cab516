// SPDX-License-Identifier: GPL-3.0-or-later
// What the triangulation on several ranks takes: one row of a table, for a noisy bumpy sphere with outliers.
// Usage: mpiexec -n RANKS eigencrust-scale-tiles POINTS | --head | POINTS --write CLOUD.ply
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include <eigencrust/io.h>
#include <eigencrust/report.h>
#include <eigencrust/stages.h>

#include "bodies.h"
#include "counter_random.h"
#include "parallel/threads.h"
#include "ranks.h"
#include "tetrahedra/assemble.h"

namespace eigencrust {
namespace {

constexpr double noise_in_spacings = 0.5;
constexpr double outlier_share = 0.01, outlier_half_side = 1.5; // of the unit sphere's box, nearly

std::vector<Vec3> noisy_bumpy_sphere(std::uint32_t count) {
  const double spacing = std::sqrt(4 * std::numbers::pi / count);
  std::vector<Vec3> points(count);
  for_each_index(Threads(0), count, [&](std::size_t i) {
    const tools::CounterRandom random(1, 0, i);
    const auto in_box = [&](std::uint64_t draw) { return outlier_half_side * (2 * random.uniform(draw) - 1); };
    if (random.uniform(0) < outlier_share) {
      points[i] = {in_box(1), in_box(2), in_box(3)};
      return;
    }
    const double noise = noise_in_spacings * spacing;
    const Vec3 direction{random.normal(1), random.normal(3), random.normal(5)};
    points[i] = bench::on_bumpy_sphere(1 / norm(direction) * direction) +
                noise * Vec3{random.normal(7), random.normal(9), random.normal(11)};
  });
  return points;
}

void print_head() {
  std::puts(
      "| ranks | points | seconds | rounds | fetched from others | sent, MB | memory of a rank, MB | of the first, MB "
      "|");
  std::puts("|---|---|---|---|---|---|---|---|");
}

void measure_root(const mpi::Messages& messages, std::uint32_t count) {
  const Threads threads(1);
  mpi::OtherRanks others(messages);
  Samples samples = prepare_samples(noisy_bumpy_sphere(count), threads);
  const auto start = std::chrono::steady_clock::now();
  mpi::TileFigures figures;
  const Tetrahedralization enclosed = enclose(std::move(samples));
  const auto tiles = others.make_tiles(enclosed, {}, 0, figures);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (tiles.empty()) throw std::runtime_error("the tiles were given up");
  const auto megabytes = [](std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; };
  std::printf("| %d | %u | %.2f | %llu | %.3f | %.1f | %.1f | %.1f |\n", messages.size(), count, seconds,
              static_cast<unsigned long long>(figures.rounds),
              static_cast<double>(figures.samples_fetched) / enclosed.sample_count, megabytes(figures.bytes_sent),
              megabytes(figures.memory_of_others), megabytes(peak_memory_bytes()));
  others.end();
}

} // namespace
} // namespace eigencrust

int main(int argc, char** argv) {
  using namespace eigencrust;
  if (argc > 1 && std::strcmp(argv[1], "--head") == 0) {
    print_head();
    return 0;
  }
  const auto count = argc > 1 ? static_cast<std::uint32_t>(std::stoul(argv[1])) : 100000;
  if (argc > 3 && std::strcmp(argv[2], "--write") == 0) {
    PointCloud cloud;
    cloud.points = noisy_bumpy_sphere(count);
    write_point_cloud(argv[3], cloud);
    return 0;
  }
  const mpi::Messages messages(argc, argv);
  if (messages.is_root())
    measure_root(messages, count);
  else
    mpi::serve(messages);
  return 0;
}
