// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "command.h"
#include "messages.h"

namespace eigencrust::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// Typical share of the whole time, from runs on clouds of different kinds; only for the percentage and the ETA.
struct StageShare {
  std::string_view name;
  double share;
};
constexpr std::array<StageShare, 33> shares{{{"reading", 3},
                                             {"samples", 4},
                                             {"sample_model", 8},
                                             {"delaunay", 24},
                                             {"stars", 1},
                                             {"poles", 4},
                                             {"evidence", 1},
                                             {"line_of_sight", 8},
                                             {"questionable", 1},
                                             {"pole_graph", 6},
                                             {"partition_poles", 10},
                                             {"label_poles", 2},
                                             {"tetrahedron_graph", 1},
                                             {"partition_tetrahedra", 1},
                                             {"energy", 8},
                                             {"minimum_cut", 8},
                                             {"overlaps", 2},
                                             {"manifold", 4},
                                             {"sheets", 1},
                                             {"handles", 4},
                                             {"pieces", 1},
                                             {"recover", 1},
                                             {"surface", 1},
                                             {"support", 1},
                                             {"components", 2},
                                             {"trim", 1},
                                             {"points", 2},
                                             {"fit", 12},
                                             {"crossings", 4},
                                             {"edges", 2},
                                             {"attributes", 1},
                                             {"validate", 10},
                                             {"writing", 3}}};

/// The fraction of the whole run, which never goes back.
class Overall {
 public:
  void begin(std::string_view stage) {
    share_ = 0;
    double before = 0;
    bool passed = false;
    for (const StageShare& s : shares) {
      if (s.name == stage) {
        passed = true;
        share_ = s.share;
      }
      if (!passed) before += s.share;
    }
    before_ = passed ? before : last_; // a stage without a share of its own stands still
  }
  double at(double fraction) {
    last_ = std::max(last_, before_ + share_ * fraction);
    return last_ / total_;
  }

 private:
  static double sum() {
    double total = 0;
    for (const StageShare& s : shares) total += s.share;
    return total;
  }
  double total_ = sum(), before_ = 0, share_ = 0, last_ = 0;
};

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

/// Columns of the terminal behind stderr; of what is none, those that $COLUMNS names, else 80.
std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* named = std::getenv("COLUMNS");
  unsigned columns = 0;
  if (named != nullptr) std::from_chars(named, named + std::string_view(named).size(), columns);
  return columns > 0 ? columns : 80;
}

/// One line that fits: what matters least goes first.
std::string bar_line(const std::string& stage, double done, const std::string& eta, std::size_t width) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%3d %%", static_cast<int>(done * 100));
  const std::string percent = text.data();
  constexpr std::size_t name_width = 21, most = 40;
  const std::size_t room = width > 0 ? width - 1 : 0; // in the last column some terminals break the line
  const std::string tail = " " + percent + "  ETA " + eta;
  std::string name = stage;
  if (room < name_width + tail.size() + 8) return (percent + " " + name).substr(0, room);
  name.resize(name_width, ' ');
  const std::size_t length = std::min(most, room - name_width - tail.size() - 3);
  std::string bar(static_cast<std::size_t>(done * static_cast<double>(length)), '#');
  bar.resize(length, ' ');
  return name + " [" + bar + "]" + tail;
}

class Bar : public Silent {
 public:
  using Silent::Silent;
  void stage_begins(std::string_view stage) override {
    stage_ = stage;
    overall_.begin(stage);
    draw(0, true);
  }
  void progress(double fraction) override { draw(fraction, false); }
  void stage_ends(std::string_view, double) override { draw(1, true); }

 private:
  void draw(double fraction, bool always) {
    const auto now = Clock::now();
    const double done = overall_.at(fraction);
    if (!always && now - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    std::string eta = "--";
    if (done > 0.05 && elapsed > 0.5)
      eta = std::to_string(static_cast<int>(std::ceil(elapsed / done * (1 - done)))) + " s";
    show_progress(bar_line(stage_, done, eta, terminal_width()));
  }

  Clock::time_point start_ = Clock::now(), drawn_{};
  std::string stage_;
  Overall overall_;
};

class JsonLines : public Silent {
 public:
  using Silent::Silent;
  void stage_begins(std::string_view stage) override {
    stage_ = stage;
    overall_.begin(stage);
    line("begin", "", overall_.at(0));
  }
  void progress(double fraction) override {
    const auto now = Clock::now();
    const double overall = overall_.at(fraction);
    if (now - written_ < std::chrono::milliseconds(200)) return;
    written_ = now;
    line("progress", ",\"fraction\":" + std::to_string(fraction), overall);
  }
  void stage_ends(std::string_view, double seconds) override {
    line("end", ",\"seconds\":" + std::to_string(seconds), overall_.at(1));
  }

 private:
  void line(const char* event, const std::string& rest, double overall) {
    print_json("\"stage\":" + json_text(stage_) + ",\"event\":\"" + event + "\"" + rest +
               ",\"overall\":" + std::to_string(overall));
  }
  std::string stage_;
  Overall overall_;
  Clock::time_point written_{};
};

} // namespace

std::unique_ptr<Observer> make_observer(const std::string& mode, const std::filesystem::path& dump_folder, bool quiet) {
  if (quiet) return std::make_unique<Silent>(dump_folder); // whatever the mode: nothing but errors
  const bool bar = mode == "bar" || (mode == "auto" && isatty(STDERR_FILENO) != 0);
  if (bar) return std::make_unique<Bar>(dump_folder);
  if (mode == "jsonl") return std::make_unique<JsonLines>(dump_folder);
  return std::make_unique<Silent>(dump_folder);
}

} // namespace eigencrust::cli
