// SPDX-License-Identifier: GPL-3.0-or-later
#include "settle/energy.h"

#include <algorithm>
#include <cmath>

namespace eigencrust {

double Energy::of(const Tetrahedralization& t, const Labels& labels, const Threads& threads) const {
  return constant + sum_blocks<double>(threads, labels.size(), [&](std::size_t begin, std::size_t end) {
           double sum = 0;
           for (TetrahedronIndex i{static_cast<std::uint32_t>(begin)}; i.value < end; ++i.value) {
             const double cost = static_cast<double>(data[i]);
             if ((cost > 0) != (labels[i] == Label::outside)) sum += std::fabs(cost);
             for (std::size_t k = 0; k < 4; ++k) {
               const TetrahedronIndex n = t.neighbours[i][k];
               if (n.valid() && n > i && labels[n] != labels[i]) sum += static_cast<double>(faces(i, k));
             }
           }
           return sum;
         });
}

double Energy::change(const Tetrahedralization& t, const Labels& labels,
                      std::span<const TetrahedronIndex> turned) const {
  double sum = 0;
  for (const TetrahedronIndex i : turned) {
    const double cost = static_cast<double>(data[i]);
    sum += labels[i] == Label::outside ? cost : -cost;
    for (std::size_t k = 0; k < 4; ++k) {
      const TetrahedronIndex n = t.neighbours[i][k];
      if (!n.valid() || std::find(turned.begin(), turned.end(), n) != turned.end()) continue;
      const double weight = static_cast<double>(faces(i, k));
      sum += labels[n] == labels[i] ? weight : -weight;
    }
  }
  return sum;
}

float Energy::balance(const Tetrahedralization& t, const Labels& labels, TetrahedronIndex i) const {
  double outside = std::max(0.0, static_cast<double>(data[i])), inside = std::max(0.0, -static_cast<double>(data[i]));
  for (std::size_t k = 0; k < 4; ++k) {
    const TetrahedronIndex n = t.neighbours[i][k];
    if (n.valid()) (labels[n] == Label::outside ? outside : inside) += static_cast<double>(faces(i, k));
  }
  return outside + inside > 0 ? static_cast<float>((outside - inside) / (outside + inside)) : 0;
}

} // namespace eigencrust
