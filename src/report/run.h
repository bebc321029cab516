// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bookkeeping around the stages: time, memory, observer. No stage knows of it.
#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include <eigencrust/observer.h>
#include <eigencrust/ranks.h>
#include <eigencrust/report.h>
#include <eigencrust/stages.h>

#include "report/describe.h"

namespace eigencrust {

/// Runs stages one after another and writes them down.
class Run {
 public:
  /// \param ranks that take over parts of the work; may be none
  Run(Report& report, Observer& observer, Ranks* ranks = nullptr)
      : report_(report), observer_(observer), ranks_(ranks) {}

  /// Runs one stage and writes down what describe() has to say of its result.
  template <class Stage>
  auto stage(const std::string& name, Stage&& work) {
    throw_if_cancelled(observer_, name);
    observer_.stage_begins(name);
    report_.stages.push_back({name, 0, 0, {}});
    if constexpr (std::is_void_v<decltype(work())>) {
      timed(work);
    } else {
      auto result = timed(work);
      if constexpr (requires { describe(result, *this); }) describe(result, *this);
      return result;
    }
  }
  void count(const std::string& what, double value) { report_.stages.back().counts.emplace_back(what, value); }
  /// The same for an earlier stage.
  void count(const std::string& stage, const std::string& what, double value) {
    const auto entry = std::find_if(report_.stages.begin(), report_.stages.end(),
                                    [&](const StageReport& s) { return s.name == stage; });
    if (entry != report_.stages.end()) entry->counts.emplace_back(what, value);
  }
  void warn(std::string text) { report_.warnings.push_back(std::move(text)); }

  [[nodiscard]] bool wants_products() { return observer_.wants_products(); }
  /// Hands the last stage's product to an observer that wants it; made only then.
  template <class Make>
  void product(const std::string& name, Make&& make) {
    if (observer_.wants_products()) observer_.product(name, make());
  }

  /// For a stage's inner loop: passes progress on and throws when cancelled.
  Checkpoint checkpoint() {
    return [this, stage = report_.stages.back().name, most = 0.0](double fraction) mutable {
      // Inner loops start again (rounds, components); what the observer sees never goes back.
      most = std::max(most, fraction);
      observer_.progress(most);
      throw_if_cancelled(observer_, stage);
    };
  }

  /// For other threads than the caller's too, while the stage runs: throws when cancelled, and tells of no progress.
  std::function<void()> cancellation() {
    return [this] {
      if (!report_.stages.empty()) throw_if_cancelled(observer_, report_.stages.back().name);
    };
  }

  Report& report() { return report_; }
  [[nodiscard]] Ranks* ranks() const { return ranks_; }
  /// Of the last stage.
  [[nodiscard]] const std::string& name() const { return report_.stages.back().name; }

  /// Writes down how long it took in all.
  void end() {
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    report_.peak_memory_bytes = peak_memory_bytes();
  }

 private:
  template <class Work>
  auto timed(Work&& work) {
    const Finish finish{*this, std::chrono::steady_clock::now()};
    return work();
  }

  struct Finish {
    Run& run;
    std::chrono::steady_clock::time_point start;
    int exceptions = std::uncaught_exceptions();
    ~Finish() noexcept(false) {
      StageReport& stage = run.report_.stages.back();
      stage.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      stage.peak_memory_bytes = peak_memory_bytes();
      try {
        run.observer_.stage_ends(stage.name, stage.seconds);
      } catch (...) {
        if (std::uncaught_exceptions() == exceptions) throw; // else the stage's own exception goes first
      }
    }
  };
  Report& report_;
  Observer& observer_;
  Ranks* ranks_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace eigencrust
