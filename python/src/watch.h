// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A run watched from Python.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <eigencrust/observer.h>

#include "arrays.h"

namespace eigencrust::python {

/// Set from any thread; asked by the run.
struct Cancellation {
  std::atomic<bool> requested = false;
};

/// Passes stages, progress and snapshots to Python's callables and their exceptions back. Python is called by the
/// thread that called reconstruct() alone, some 20 times a second at most; workers look at a flag and need no
/// interpreter lock.
class Watch : public Observer {
 public:
  /// \param progress  progress(stage, fraction); what it returns cancels the run if it is False; or None
  /// \param cancel    a Cancellation or None
  /// \param snapshots snapshots(stage, mesh) or None
  Watch(py::object progress, const py::object& cancel, py::object snapshots);

  /// Runs without the interpreter lock. A callable's exception goes before the Error{cancelled} that it caused.
  template <class Work>
  auto run(Work&& work) {
    try {
      const py::gil_scoped_release unlocked;
      return work();
    } catch (...) {
      if (raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

  void stage_begins(std::string_view stage) override;
  void progress(double fraction) override;
  bool cancelled() override;
  bool wants_products() override { return has_snapshots_; }
  void product(std::string_view stage, const TriangleMesh& snapshot) override;

 private:
  using Clock = std::chrono::steady_clock;

  /// Calls into Python; what is raised there stops the run.
  template <class Call>
  void guarded(Call&& call);
  void tell(double fraction);

  py::object progress_, snapshots_;
  bool has_progress_, has_snapshots_;
  std::shared_ptr<Cancellation> cancel_;
  std::atomic<bool> stop_ = false;
  std::exception_ptr raised_;
  std::string stage_;
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point told_ = Clock::now(), looked_ = Clock::now();
};

} // namespace eigencrust::python
