// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a run is watched and cancelled.
#pragma once

#include <string_view>

#include <eigencrust/types.h>

namespace eigencrust {

/// Watches a reconstruction. The default does nothing. Calls come from the thread that called
/// reconstruct(), never from two threads at once; `cancelled` alone may be called from worker threads
/// and must be safe to call from several at once.
class Observer {
 public:
  virtual ~Observer() = default;
  /// A stage has begun.
  virtual void stage_begins(std::string_view /*stage*/) {}
  /// How much of the current stage is done, in [0, 1], never decreasing within a stage.
  virtual void progress(double /*fraction*/) {}
  /// A stage is over.
  virtual void stage_ends(std::string_view /*stage*/, double /*seconds*/) {}
  /// Return true to stop at the next check; reconstruct() then throws ErrorKind::cancelled.
  virtual bool cancelled() { return false; }
  /// Return true to be given the stages' products through `product`.
  virtual bool wants_products() { return false; }
  /// A stage's product as a mesh with named attributes (points when it has no triangles).
  virtual void product(std::string_view /*stage*/, const TriangleMesh& /*snapshot*/) {}
};

/// An observer that does nothing.
Observer* default_observer();

/// Throws Error{cancelled} naming the stage when the observer asks for it.
void throw_if_cancelled(Observer& observer, std::string_view stage);

} // namespace eigencrust
