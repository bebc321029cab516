// SPDX-License-Identifier: GPL-3.0-or-later
// Random clouds through the method with random options: each gives a mesh that keeps what docs/guarantees.md promises,
// or an Error of a documented kind. To be built with sanitizers.
// Usage: fuzz_method FIRST_SEED COUNT      runs so many, one line for each finding, a table at the end
//        fuzz_method show SEED             the cloud of a seed as x y z, its options on stderr
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>
#include <string>

#include <eigencrust/eigencrust.h>
#include <eigencrust/error.h>
#include <eigencrust/validate.h>

#include "random_runs.h"

namespace {

using namespace eigencrust;
using fuzz::RandomRun;

/// Is each vertex the row that it says it came from, bit for bit?
bool vertices_are_rows(const TriangleMesh& mesh, const PointCloud& cloud) {
  const Attribute* source = find_attribute(mesh.vertex_attributes, "source_index");
  if (source == nullptr || source->rows() != mesh.vertices.size()) return false;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v] != cloud.points[static_cast<std::size_t>(attribute_value(*source, v))]) return false;
  return true;
}

/// The first promise that does not hold; empty: all do.
std::string broken_promise(const RandomRun& run, const Result& result) {
  const Options& o = run.options;
  if (!result.report.broken_guarantees.empty()) return "status 6: not " + result.report.broken_guarantees.front();
  if (result.mesh.triangles.empty()) return "no triangles, no error";
  const MeshSummary mesh = validate(result.mesh, {.threads = 1});
  const SceneKind kind = result.report.surroundings.kind;
  const bool may_be_open = (kind == SceneKind::facade && !o.base) || o.trim;
  if (o.facade && kind != SceneKind::facade) return "not the side that was named";
  if (!may_be_open && !mesh.closed()) return "not closed";
  const bool may_touch = o.method != Method::eigencrust && o.method != Method::spectral_cocone; // docs/crusts.md
  if (o.manifold && !may_touch && !mesh.manifold()) return "not a manifold";
  if (o.manifold && !mesh.oriented()) return "not oriented";
  // Rooms face who scanned them from within.
  if (mesh.closed() && mesh.oriented() && (kind == SceneKind::interior ? mesh.volume > 0 : mesh.volume < 0))
    return kind == SceneKind::interior ? "a room faces away from the scanners" : "inward";
  const bool of_poles = o.method == Method::powercrust || o.method == Method::spectral_powercrust;
  const auto& simplified = result.report.simplified;
  if (simplified && simplified->max_error > 0 && !(simplified->deviation.max() <= simplified->max_error))
    return "farther off than --max-error";
  if (!result.report.moved && !simplified && !o.base && !of_poles && !vertices_are_rows(result.mesh, run.cloud))
    return "a vertex is no row of the input";
  if (o.surface == SurfaceKind::samples && o.smooth == 0 && result.report.moved) return "moved without being asked to";
  if (!of_poles && result.report.mesh.self_intersections != mesh.self_intersections) return "crossings not told";
  if ((result.report.moved || simplified) && !o.base && mesh.self_intersections > 0) return "crossings of what moved";
  if (o.point_results && result.inlier.size() != run.cloud.points.size()) return "rows without a verdict";
  return {};
}

bool is_expected(ErrorKind kind, const Options& o) {
  if (kind == ErrorKind::usage)
    return !o.outside_points.empty() || !o.inside_points.empty() || o.base ||
           o.edge.kind != SurfaceLength::Kind::off; // too short
  if (kind == ErrorKind::memory) return o.max_memory > 0;
  return kind == ErrorKind::input || kind == ErrorKind::no_surface;
}

struct Outcome {
  std::string name;    ///< for the table
  std::string finding; ///< empty: none
};

Outcome outcome_of(RandomRun& run, std::uint64_t seed) {
  try {
    const Result result = reconstruct(run.cloud, run.options);
    std::string finding = broken_promise(run, result);
    constexpr std::uint64_t every = 8; // a second time with four threads
    if (finding.empty() && seed % every == 0) {
      run.options.threads = 4;
      const Result again = reconstruct(run.cloud, run.options);
      if (again.mesh.triangles != result.mesh.triangles || again.mesh.vertices != result.mesh.vertices)
        finding = "another mesh with four threads";
    }
    return {"mesh", finding};
  } catch (const Error& error) {
    const std::string kind = "status " + std::to_string(static_cast<int>(error.kind()));
    return {kind, is_expected(error.kind(), run.options) ? "" : kind + ": " + error.what()};
  } catch (const std::exception& error) {
    return {"exception", std::string("exception: ") + error.what()};
  }
}

// A run that hangs is a finding, too; a handler can reach nothing but what has static storage.
volatile std::sig_atomic_t running_low = 0, running_high = 0;

/// Names the seed that was running when the time was over, or when an assertion failed.
void on_end(int signal) {
  const auto seed = static_cast<std::uint64_t>(static_cast<std::uint32_t>(running_high)) << 31 |
                    static_cast<std::uint32_t>(running_low);
  char text[100];
  const int size = std::snprintf(text, sizeof text, "seed %llu: %s\n", static_cast<unsigned long long>(seed),
                                 signal == SIGABRT ? "aborts" : "hangs");
  [[maybe_unused]] const ssize_t ignored = write(STDOUT_FILENO, text, static_cast<std::size_t>(size));
  _exit(1);
}

void watch(std::uint64_t seed) {
  // Seconds of the processor; most runs take a twentieth, skew lines with Lanczos three minutes under sanitizers.
  constexpr unsigned patience = 600, busy = 4;
  running_low = static_cast<std::sig_atomic_t>(seed & 0x7fffffffu);
  running_high = static_cast<std::sig_atomic_t>(seed >> 31 & 0x7fffffffu);
  std::signal(SIGALRM, on_end);
  std::signal(SIGPROF, on_end);
  std::signal(SIGABRT, on_end);
  alarm(busy * patience); // a run that waits for ever uses no processor
  const itimerval timer{{0, 0}, {patience, 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

int show(std::uint64_t seed) {
  const RandomRun run = fuzz::random_run(seed);
  std::fprintf(stderr, "%s\n%s\n", run.shape.c_str(), fuzz::describe(run.options).c_str());
  for (const Vec3& p : run.cloud.points) std::printf("%.17g %.17g %.17g\n", p.x, p.y, p.z);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: fuzz_method FIRST_SEED COUNT | fuzz_method show SEED\n");
    return 2;
  }
  if (std::string(argv[1]) == "show") return show(std::strtoull(argv[2], nullptr, 10));
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10), count = std::strtoull(argv[2], nullptr, 10);
  std::map<std::string, std::uint64_t> outcomes;
  std::uint64_t findings = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    RandomRun run = fuzz::random_run(seed);
    if (std::getenv("EIGENCRUST_FUZZ_VERBOSE") != nullptr)
      std::fprintf(stderr, "seed %llu\n", static_cast<unsigned long long>(seed));
    watch(seed);
    const Outcome outcome = outcome_of(run, seed);
    ++outcomes[outcome.name];
    if (outcome.finding.empty()) continue;
    ++findings;
    std::printf("seed %llu: %s (%s, %zu points, %s)\n", static_cast<unsigned long long>(seed), outcome.finding.c_str(),
                run.shape.c_str(), run.cloud.points.size(), fuzz::describe(run.options).c_str());
    std::fflush(stdout);
  }
  std::printf("seeds %llu to %llu:", static_cast<unsigned long long>(first),
              static_cast<unsigned long long>(first + count - 1));
  for (const auto& [name, number] : outcomes)
    std::printf(" %s %llu,", name.c_str(), static_cast<unsigned long long>(number));
  std::printf(" findings %llu\n", static_cast<unsigned long long>(findings));
  return findings == 0 ? 0 : 1;
}
