// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/passed_sheets.h"

#include <algorithm>
#include <vector>

#include "parallel/threads.h"

namespace eigencrust {
namespace {

// Fewer samples are a corner or a tip, or chance.
constexpr std::size_t least_of_sheet = 50;
// In spacings: samples beside one another are no farther apart.
constexpr double beside_in_spacings = 3;

class SheetFinder {
 public:
  explicit SheetFinder(const Moves& moves) : moves_(moves), t_(moves.scene.t), in_sheet_(t_.sample_count, 0) {
    const std::size_t n = t_.sample_count;
    std::vector<std::uint8_t> passed(n);
    for_each_index(moves.scene.threads, n, [&](std::size_t s) { passed[s] = is_passed(sample(s)); });
    for_each_index(moves.scene.threads, n, [&](std::size_t s) {
      if (!passed[s]) return;
      // Noise passes by some here and there; of a sheet most are.
      const std::vector<std::uint32_t> around = beside(sample(s));
      const auto others = std::count_if(around.begin(), around.end(), [&](std::uint32_t o) { return passed[o]; });
      in_sheet_[s] = 2 * static_cast<std::size_t>(others) >= around.size();
    });
  }

  PassedSheetsReport find() {
    PassedSheetsReport result;
    std::size_t largest = 0;
    for (std::size_t s = 0; s < in_sheet_.size(); ++s) {
      if (!in_sheet_[s]) continue;
      const std::vector<SampleIndex> sheet = take_from(sample(s));
      if (sheet.size() < least_of_sheet) continue;
      ++result.sheets;
      result.samples += sheet.size();
      if (sheet.size() <= largest) continue;
      largest = sheet.size();
      result.at = middle_of(sheet);
    }
    return result;
  }

 private:
  static SampleIndex sample(std::size_t s) { return SampleIndex{static_cast<std::uint32_t>(s)}; }

  [[nodiscard]] bool is_passed(SampleIndex s) const {
    const PricedLabels& labels = moves_.labels();
    return !moves_.scene.model.is_noisy(s) && !labels.on_surface(s) &&
           labels[moves_.scene.stars[s].front()] == Label::outside;
  }

  /// Distinct, increasing.
  [[nodiscard]] std::vector<std::uint32_t> beside(SampleIndex s) const {
    const double reach = beside_in_spacings * static_cast<double>(moves_.scene.model.spacing[s]);
    std::vector<std::uint32_t> around;
    for (const TetrahedronIndex i : moves_.scene.stars[s])
      for (const VertexIndex v : t_.tetrahedra[i])
        if (v != s && !t_.is_corner(v) && squared_norm(t_.positions[v] - t_.positions[s]) < reach * reach)
          around.push_back(v.value);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }

  /// All of its sheet, which are of none afterwards.
  std::vector<SampleIndex> take_from(SampleIndex first) {
    std::vector<SampleIndex> sheet{first};
    in_sheet_[first.value] = 0;
    for (std::size_t k = 0; k < sheet.size(); ++k)
      for (const std::uint32_t o : beside(sheet[k])) {
        if (!in_sheet_[o]) continue;
        in_sheet_[o] = 0;
        sheet.push_back(sample(o));
      }
    return sheet;
  }

  [[nodiscard]] Vec3 middle_of(const std::vector<SampleIndex>& sheet) const {
    Vec3 middle;
    for (const SampleIndex s : sheet) middle = middle + (1 / static_cast<double>(sheet.size())) * t_.positions[s];
    return middle + t_.origin;
  }

  const Moves& moves_;
  const Tetrahedralization& t_;
  std::vector<std::uint8_t> in_sheet_;
};

} // namespace

PassedSheetsReport passed_sheets(const Moves& moves) { return SheetFinder(moves).find(); }

} // namespace eigencrust
