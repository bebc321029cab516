// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A run that was ended goes on where it was.
#pragma once

#include <eigencrust/ranks.h>
#include <eigencrust/stages.h>

#include <string>
#include <vector>

namespace eigencrust::cli {

/// Keeps the tetrahedra in a folder until the run's result is there, under a name that follows from the samples.
class KeptTetrahedra : public Ranks {
 public:
  /// \param resume takes what an earlier run left there
  /// \param ranks that make them; none: this process does
  /// \param limit_of_ranks bytes that each of them may take, also where this one goes out of core; 0: no limit
  KeptTetrahedra(std::string folder, bool resume, Ranks* ranks, std::uint64_t limit_of_ranks)
      : folder_(std::move(folder)), resume_(resume), ranks_(ranks), limit_of_ranks_(limit_of_ranks) {}

  Tetrahedralization tetrahedralize(Samples samples, const Threads& threads, const WatchGrowth& watch,
                                    std::uint64_t max_memory) override;
  [[nodiscard]] std::vector<std::pair<std::string, double>> counts() const override;

  /// What could not be kept, or not be used.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  /// The result is there: they are not needed any more.
  void forget() const;

 private:
  std::string folder_, file_;
  bool resume_, resumed_ = false;
  Ranks* ranks_;
  std::uint64_t limit_of_ranks_;
  std::vector<std::string> warnings_;

  /// Without tetrahedra: there are none of these samples, or they are damaged.
  Tetrahedralization kept(Samples& samples);
  void keep(const Tetrahedralization& tetrahedralization);
};

} // namespace eigencrust::cli
