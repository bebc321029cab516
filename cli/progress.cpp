// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "command.h"

namespace eigencrust::cli {
namespace {

using Clock = std::chrono::steady_clock;

bool bar_is_shown = false; // one terminal line per process

/// Typical share of the whole time, from runs on a million points; only for the percentage and the ETA.
struct StageShare {
  std::string_view name;
  double share;
};
constexpr std::array<StageShare, 27> shares{{{"samples", 4},
                                             {"sample_model", 4},
                                             {"delaunay", 24},
                                             {"stars", 1},
                                             {"poles", 4},
                                             {"evidence", 1},
                                             {"line_of_sight", 12},
                                             {"questionable", 1},
                                             {"pole_graph", 8},
                                             {"partition_poles", 15},
                                             {"label_poles", 2},
                                             {"tetrahedron_graph", 2},
                                             {"partition_tetrahedra", 20},
                                             {"energy", 8},
                                             {"minimum_cut", 8},
                                             {"manifold", 4},
                                             {"handles", 4},
                                             {"recover", 1},
                                             {"surface", 1},
                                             {"support", 1},
                                             {"components", 2},
                                             {"trim", 1},
                                             {"fit", 12},
                                             {"crossings", 4},
                                             {"attributes", 1},
                                             {"validate", 10}}};

class Silent : public Observer {
 public:
  explicit Silent(std::filesystem::path dump_folder) : dump_folder_(std::move(dump_folder)) {}
  bool cancelled() override { return interrupted(); }
  bool wants_products() override { return !dump_folder_.empty(); }
  void product(std::string_view stage, const TriangleMesh& snapshot) override {
    std::array<char, 8> number{};
    std::snprintf(number.data(), number.size(), "%02u_", ++products_);
    write_mesh(dump_folder_ / (number.data() + std::string(stage) + ".ply"), snapshot, {});
  }

 private:
  std::filesystem::path dump_folder_;
  unsigned products_ = 0;
};

class Bar : public Silent {
 public:
  using Silent::Silent;
  void stage_begins(std::string_view stage) override {
    stage_ = stage;
    share_ = 0;
    before_ = 0;
    total_ = 0;
    bool passed = false;
    for (const StageShare& s : shares) {
      if (s.name == stage) {
        passed = true;
        share_ = s.share;
      }
      if (!passed) before_ += s.share;
      total_ += s.share;
    }
    if (!passed) before_ = last_; // a stage without a share of its own stands still
    draw(0, true);
  }
  void progress(double fraction) override { draw(fraction, false); }
  void stage_ends(std::string_view, double) override { draw(1, true); }

 private:
  void draw(double fraction, bool always) {
    const auto now = Clock::now();
    if (!always && now - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = now;
    last_ = std::fmax(last_, before_ + share_ * fraction);
    const double done = last_ / total_;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const int filled = static_cast<int>(done * 24);
    std::string eta = "--";
    if (done > 0.05 && elapsed > 0.5)
      eta = std::to_string(static_cast<int>(std::ceil(elapsed / done * (1 - done)))) + " s";
    std::fprintf(stderr, "\r\033[K%-21.*s [%-24s] %3d %%  ETA %s", static_cast<int>(stage_.size()), stage_.data(),
                 std::string(static_cast<std::size_t>(filled), '#').c_str(), static_cast<int>(done * 100), eta.c_str());
    std::fflush(stderr);
    bar_is_shown = true;
  }

  Clock::time_point start_ = Clock::now(), drawn_{};
  std::string stage_;
  double before_ = 0, share_ = 0, total_ = 1, last_ = 0;
};

class JsonLines : public Silent {
 public:
  using Silent::Silent;
  void stage_begins(std::string_view stage) override {
    stage_ = stage;
    line("begin", "");
  }
  void progress(double fraction) override {
    const auto now = Clock::now();
    if (now - written_ < std::chrono::milliseconds(200)) return;
    written_ = now;
    line("progress", ",\"fraction\":" + std::to_string(fraction));
  }
  void stage_ends(std::string_view, double seconds) override { line("end", ",\"seconds\":" + std::to_string(seconds)); }

 private:
  void line(const char* event, const std::string& rest) {
    std::fprintf(stderr, "{\"stage\":\"%s\",\"event\":\"%s\"%s}\n", stage_.c_str(), event, rest.c_str());
    std::fflush(stderr);
  }
  std::string stage_;
  Clock::time_point written_{};
};

} // namespace

void clear_progress() {
  if (!bar_is_shown) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  bar_is_shown = false;
}

std::unique_ptr<Observer> make_observer(const std::string& mode, const std::filesystem::path& dump_folder, bool quiet) {
  if (quiet) return std::make_unique<Silent>(dump_folder); // whatever the mode: nothing but errors
  const bool bar = mode == "bar" || (mode == "auto" && isatty(STDERR_FILENO) != 0);
  if (bar) return std::make_unique<Bar>(dump_folder);
  if (mode == "jsonl") return std::make_unique<JsonLines>(dump_folder);
  return std::make_unique<Silent>(dump_folder);
}

} // namespace eigencrust::cli
