// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far a run has come: a bar for people, lines of JSON for programs.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include <eigencrust/observer.h>

namespace eigencrust::cli {

/// `mode` is auto, bar, jsonl or off; auto shows a bar on a terminal.
std::unique_ptr<Observer> make_observer(const std::string& mode, const std::filesystem::path& dump_folder, bool quiet);

/// Reading and writing as stages like those of the method, from its making to end().
class FileStage {
 public:
  /// \throws Error{cancelled}
  FileStage(Observer& observer, const char* name) : observer_(observer), name_(name) {
    throw_if_cancelled(observer, name);
    observer.stage_begins(name);
  }
  /// \throws Error{cancelled}
  void progress(double fraction) {
    observer_.progress(fraction);
    throw_if_cancelled(observer_, name_);
  }
  void end() {
    observer_.stage_ends(name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
  }

 private:
  Observer& observer_;
  const char* name_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace eigencrust::cli
