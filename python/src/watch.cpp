// SPDX-License-Identifier: GPL-3.0-or-later
#include "watch.h"

namespace eigencrust::python {
namespace {

constexpr std::chrono::milliseconds between_calls{50};

} // namespace

Watch::Watch(py::object progress, const py::object& cancel, py::object snapshots)
    : progress_(std::move(progress)),
      snapshots_(std::move(snapshots)),
      has_progress_(!progress_.is_none()),
      has_snapshots_(!snapshots_.is_none()) {
  if (!cancel.is_none()) cancel_ = cancel.cast<std::shared_ptr<Cancellation>>();
}

template <class Call>
void Watch::guarded(Call&& call) {
  const py::gil_scoped_acquire locked;
  try {
    call();
  } catch (py::error_already_set&) {
    if (!raised_) raised_ = std::current_exception();
    stop_ = true;
  }
}

void Watch::tell(double fraction) {
  if (!has_progress_ || stop_) return;
  guarded([&] {
    const py::object answer = progress_(stage_, fraction);
    if (answer.ptr() == Py_False) stop_ = true;
  });
  told_ = Clock::now();
}

void Watch::stage_begins(std::string_view stage) {
  stage_ = stage;
  tell(0);
}

void Watch::progress(double fraction) {
  if (Clock::now() - told_ >= between_calls) tell(fraction);
}

bool Watch::cancelled() {
  if (stop_ || (cancel_ && cancel_->requested)) return true;
  if (std::this_thread::get_id() != caller_ || Clock::now() - looked_ < between_calls) return false;
  looked_ = Clock::now();
  // Ctrl-C, if this is Python's main thread.
  guarded([] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  });
  return stop_;
}

void Watch::product(std::string_view stage, const TriangleMesh& snapshot) {
  if (stop_) return;
  guarded([&] { snapshots_(std::string(stage), std::make_shared<TriangleMesh>(snapshot)); });
}

} // namespace eigencrust::python
