// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: soak memory RUNS POINTS   reconstructs so often in one process; fails where memory grows after the first 100
//        soak threads POINTS       the pipeline, lines of sight, a session, and two reconstructions at once, each with
//                                  four threads; to be built with the thread sanitizer
//        soak race                 a race on purpose: where the sanitizer says nothing of it, it sees none
#include <malloc.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <thread>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/session.h>
#include <eigencrust/threads.h>

namespace {

using namespace eigencrust;

/// A noisy sphere along a spiral with the golden angle, and a few stray points.
PointCloud noisy_sphere(std::uint32_t n, std::uint32_t variant) {
  PointCloud cloud;
  std::uint64_t state = variant + 1;
  const auto random = [&] { // splitmix64
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  };
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0)), noise = 0.5 / std::sqrt(static_cast<double>(n));
  for (std::uint32_t i = 0; i < n; ++i) {
    const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), size = 1 + noise * (random() - 0.5);
    cloud.points.push_back({size * r * std::cos(i * golden), size * r * std::sin(i * golden), size * z});
    if (i % 97 == 0) cloud.points.push_back({3 * random() - 1.5, 3 * random() - 1.5, 3 * random() - 1.5});
  }
  return cloud;
}

void see_from(PointCloud& cloud) {
  cloud.sensors = {{{5, 0, 0}, false}, {{-5, 1, 0}, false}, {{0, 0, 1}, true}};
  for (const Vec3& p : cloud.points) cloud.sensor_of.push_back(p.x > 0.3 ? 0 : p.x < -0.3 ? 1 : 2);
}

/// Without what the allocator keeps for later, which is now more and now less: a tenth of the little that there is.
std::uint64_t resident_kilobytes() {
  malloc_trim(0);
  std::ifstream file("/proc/self/status");
  std::uint64_t kilobytes = 0;
  for (std::string word; file >> word;)
    if (word == "VmRSS:" && file >> kilobytes) return kilobytes;
  return 0;
}

int soak_memory(std::uint32_t runs, std::uint32_t points) {
  std::uint64_t early = 0;
  std::uint32_t without = 0;
  constexpr std::uint32_t warm = 100;
  for (std::uint32_t i = 1; i <= runs; ++i) {
    PointCloud cloud = noisy_sphere(points, i % 16); // the same shapes again and again
    if (i % 2 == 0) see_from(cloud);
    Options options = Options::of(i % 3 == 0 ? Preset::paper : Preset::robust);
    options.smooth = i % 5 == 0 ? 2 : 0;
    options.point_results = i % 7 == 0;
    options.threads = 1 + i % 4;
    try {
      reconstruct(cloud, options);
    } catch (const Error& error) { // without a surface memory has to come back as well
      if (error.kind() != ErrorKind::no_surface) throw;
      ++without;
    }
    if (i == warm) early = resident_kilobytes();
    if (i % 1000 == 0) {
      std::printf("%u runs: %llu kB\n", i, static_cast<unsigned long long>(resident_kilobytes()));
      std::fflush(stdout); // a run that is stopped leaves what it has
    }
  }
  const std::uint64_t late = resident_kilobytes();
  std::printf("resident after %u runs %llu kB, after %u runs %llu kB; %u runs without a surface\n", warm,
              static_cast<unsigned long long>(early), runs, static_cast<unsigned long long>(late), without);
  constexpr double most_growth = 1.02;
  return static_cast<double>(late) <= most_growth * static_cast<double>(early) ? 0 : 1;
}

int soak_threads(std::uint32_t points) {
  Options options;
  options.threads = 4;
  options.point_results = true;
  PointCloud cloud = noisy_sphere(points, 1);
  const Result plain = reconstruct(cloud, options);
  see_from(cloud);
  const Result seen = reconstruct(cloud, options);
  Session session(cloud, options);
  const Result labelled = session.label(std::vector<Vec3>{{3, 3, 3}}, std::vector<Vec3>{{0, 0, 0}});
  Result beside;
  std::thread other([&] { beside = reconstruct(cloud, options); });
  const Result again = reconstruct(cloud, options);
  other.join();
  const bool same = again.mesh.triangles == seen.mesh.triangles && beside.mesh.triangles == seen.mesh.triangles;
  std::printf("triangles: %zu, with sensors %zu, of the session %zu; two at once: %s\n", plain.mesh.triangles.size(),
              seen.mesh.triangles.size(), labelled.mesh.triangles.size(), same ? "the same" : "others");
  return same ? 0 : 1;
}

/// Blocks that have no order write the same number. What is written before and read after a run is no race.
int race() {
  const Threads threads(2);
  std::vector<std::uint32_t> own(1000, 1);
  std::uint32_t shared = 0;
  for (int repeat = 0; repeat < 100; ++repeat) // one thread alone may take all blocks of a run
    threads.run(own.size(), [&](std::size_t block) { shared += own[block]++; });
  std::printf("%u\n", shared);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const auto number = [&](int i) { return static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)); };
  if (what == "memory" && argc == 4) return soak_memory(number(2), number(3));
  if (what == "threads" && argc == 3) return soak_threads(number(2));
  if (what == "race" && argc == 2) return race();
  std::fprintf(stderr, "usage: soak memory RUNS POINTS | soak threads POINTS | soak race\n");
  return 2;
}
