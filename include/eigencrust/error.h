// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The one exception type: where, what, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>

namespace eigencrust {

/// What kind of trouble it was. The command returns these values as its exit status.
enum class ErrorKind : int {
  usage = 2,      ///< options that make no sense
  input = 3,      ///< input unreadable or unusable
  memory = 4,     ///< memory refused or exhausted
  no_surface = 5, ///< the labels leave no surface
  guarantee = 6,  ///< a promised property of the result does not hold
  cancelled = 130 ///< cancelled through the observer
};

/// Thrown by every function of the library that cannot do what it promises.
class Error : public std::runtime_error {
 public:
  /// \param place  FILE:LINE, FILE or the name of a stage
  /// \param cause  what is wrong, without a full stop
  /// \param remedy what the caller can do about it, an imperative without a full stop
  Error(ErrorKind kind, std::string place, std::string cause, std::string remedy)
      : std::runtime_error(cause + " (" + place + "); " + remedy),
        kind_(kind),
        place_(std::move(place)),
        cause_(std::move(cause)),
        remedy_(std::move(remedy)) {}

  /// Which sort of error.
  [[nodiscard]] ErrorKind kind() const { return kind_; }
  /// The stage, option or file where it happened.
  [[nodiscard]] const std::string& place() const { return place_; }
  /// What is wrong.
  [[nodiscard]] const std::string& cause() const { return cause_; }
  /// What the caller can do about it.
  [[nodiscard]] const std::string& remedy() const { return remedy_; }

 private:
  ErrorKind kind_;
  std::string place_, cause_, remedy_;
};

} // namespace eigencrust
