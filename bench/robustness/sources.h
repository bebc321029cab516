// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files that cases are made of, each read once, and results that serve other cases as a reference.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <eigencrust/types.h>

#include "bodies.h"

namespace eigencrust::bench {

class Sources {
 public:
  /// \param field folder of the files whose name begins with "field/"
  Sources(std::filesystem::path folder, unsigned threads, std::filesystem::path field = {})
      : folder_(std::move(folder)), field_(std::move(field)), threads_(threads) {}

  [[nodiscard]] unsigned threads() const { return threads_; }
  [[nodiscard]] bool has(const std::string& file) const;
  [[nodiscard]] std::filesystem::path path(const std::string& file) const;

  /// A closed mesh with what is known of it. \throws Error{input}
  const Truth& truth(const std::string& file);
  /// \throws Error{input}
  const std::vector<Vec3>& points(const std::string& file);
  /// What the preset `robust` makes of a cloud as it is. \throws Error
  const Truth& reference(const std::string& file);

 private:
  std::filesystem::path folder_, field_;
  unsigned threads_;
  std::map<std::string, Truth> truths_, references_;
  std::map<std::string, std::vector<Vec3>> points_;
};

} // namespace eigencrust::bench
