// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Several processes that make one mesh together.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <eigencrust/types.h>

namespace eigencrust {

struct Samples;
class Threads;

/// Other processes that take over parts of a reconstruction. The result is the same, byte for byte.
class Ranks {
 public:
  virtual ~Ranks() = default;
  /// As tetrahedralize() in stages.h.
  /// \param watch called every few samples of this process with the fraction done and the number of tetrahedra here so
  /// far, at last with that of all; may throw to end the work of all
  /// \param max_memory bytes that each process may take, see Options; 0: no limit
  virtual Tetrahedralization tetrahedralize(Samples samples, const Threads& threads,
                                            const std::function<void(double, std::uint64_t)>& watch,
                                            std::uint64_t max_memory) = 0;
  /// What there is to know of the last work, for the counts of its stage: name and value, see docs/report.md.
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> counts() const = 0;
};

} // namespace eigencrust
