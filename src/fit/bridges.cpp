// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/bridges.h"

#include <algorithm>
#include <utility>

#include <Eigen/SparseCholesky>

namespace eigencrust {
namespace {

/// Where there is nothing else there is no bridge.
std::vector<std::uint32_t> without_pieces_of_strays(std::vector<std::uint32_t> strays, const SurfaceFans& fans) {
  if (strays.empty()) return strays;
  const std::vector<std::uint32_t> piece = fans.pieces();
  std::vector<std::uint8_t> has_others(piece.size(), 0);
  auto stray = strays.begin();
  for (std::uint32_t v = 0; v < piece.size(); ++v)
    if (stray != strays.end() && *stray == v)
      ++stray;
    else
      has_others[piece[v]] = 1;
  std::erase_if(strays, [&](std::uint32_t v) { return has_others[piece[v]] == 0; });
  return strays;
}

} // namespace

std::vector<std::uint32_t> strays_on_bridges(const Surface& surface, const SurfaceFans& fans,
                                             const SampleModel& model) {
  std::vector<std::uint8_t> is_borne_out(surface.sample_of.size(), 0);
  for (std::size_t i = 0; i < surface.mesh.triangles.size(); ++i)
    if (!surface.unsupported[i])
      for (const std::uint32_t v : surface.mesh.triangles[i]) is_borne_out[v] = 1;
  std::vector<std::uint32_t> strays;
  for (std::uint32_t v = 0; v < is_borne_out.size(); ++v)
    if (model.isolated[surface.sample_of[v]] > 0 && !is_borne_out[v] && !fans.at_rim(v)) strays.push_back(v);
  return without_pieces_of_strays(std::move(strays), fans);
}

void flatten_bridges(std::span<const std::uint32_t> strays, const SurfaceFans& fans, std::vector<Vec3>& vertices) {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d sums = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(strays.size()), 3);
  for (Eigen::Index row = 0; row < sums.rows(); ++row) {
    const auto wings = fans[strays[static_cast<std::size_t>(row)]];
    entries.emplace_back(row, row, static_cast<double>(wings.size()));
    for (const auto& [next, last] : wings) {
      const auto at = std::lower_bound(strays.begin(), strays.end(), next);
      if (at != strays.end() && *at == next)
        entries.emplace_back(row, at - strays.begin(), -1.0);
      else
        sums.row(row) += Eigen::RowVector3d(vertices[next].x, vertices[next].y, vertices[next].z);
    }
  }
  Matrix laplacian(sums.rows(), sums.rows());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixX3d places = Eigen::SimplicialLDLT<Matrix>(laplacian).solve(sums);
  for (Eigen::Index row = 0; row < places.rows(); ++row)
    vertices[strays[static_cast<std::size_t>(row)]] = {places(row, 0), places(row, 1), places(row, 2)};
}

} // namespace eigencrust
