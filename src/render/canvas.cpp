// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigencrust {
namespace {

constexpr float nothing = -std::numeric_limits<float>::infinity();
constexpr int per_side = 3; ///< samples along one side of a pixel
constexpr std::uint32_t band_rows = 16;

/// The samples of a band of pixel rows. Bands are drawn independently, each all primitives in order,
/// so that the picture does not depend on threads and memory stays small.
class Band {
 public:
  Band(std::uint32_t width, std::uint32_t first_row, std::uint32_t end_row)
      : samples_(static_cast<std::ptrdiff_t>(width) * per_side),
        first_(static_cast<std::ptrdiff_t>(first_row) * per_side),
        end_(static_cast<std::ptrdiff_t>(end_row) * per_side),
        depth_(static_cast<std::size_t>(samples_ * (end_ - first_)), nothing),
        color_(depth_.size()) {}

  /// draw(x, y, sample number) for the samples whose position lies in [x0, x1] × [y0, y1].
  template <class Draw>
  void for_each_sample(double x0, double x1, double y0, double y1, Draw&& draw) {
    const std::ptrdiff_t i0 = first_at(x0, 0, samples_), i1 = end_at(x1, 0, samples_);
    const std::ptrdiff_t j0 = first_at(y0, first_, end_), j1 = end_at(y1, first_, end_);
    for (std::ptrdiff_t j = j0; j < j1; ++j)
      for (std::ptrdiff_t i = i0; i < i1; ++i)
        draw(position(i), position(j), static_cast<std::size_t>((j - first_) * samples_ + i));
  }

  void put(std::size_t sample, double depth, const LinearColor& color) {
    depth_[sample] = static_cast<float>(depth);
    color_[sample] = color;
  }
  [[nodiscard]] bool hides(std::size_t sample, double depth) const {
    return static_cast<float>(depth) <= depth_[sample];
  }

  void resolve(Canvas& canvas) const {
    constexpr float share = 1.0F / (per_side * per_side);
    for (std::ptrdiff_t j = first_; j < end_; ++j)
      for (std::ptrdiff_t i = 0; i < samples_; ++i) {
        const auto sample = static_cast<std::size_t>((j - first_) * samples_ + i);
        if (depth_[sample] == nothing) continue;
        const auto pixel = static_cast<std::size_t>((j / per_side) * (samples_ / per_side) + i / per_side);
        for (std::size_t c = 0; c < 3; ++c) canvas.color[pixel][c] += share * color_[sample][c];
        canvas.coverage[pixel] += share;
        canvas.depth[pixel] = std::max(canvas.depth[pixel], depth_[sample]);
      }
  }

 private:
  static double position(std::ptrdiff_t i) { return (static_cast<double>(i) + 0.5) / per_side; }
  static std::ptrdiff_t first_at(double x, std::ptrdiff_t lo, std::ptrdiff_t hi) {
    return static_cast<std::ptrdiff_t>(
        std::clamp(std::ceil(x * per_side - 0.5), static_cast<double>(lo), static_cast<double>(hi)));
  }
  static std::ptrdiff_t end_at(double x, std::ptrdiff_t lo, std::ptrdiff_t hi) {
    return static_cast<std::ptrdiff_t>(
        std::clamp(std::floor(x * per_side - 0.5) + 1, static_cast<double>(lo), static_cast<double>(hi)));
  }

  std::ptrdiff_t samples_, first_, end_;
  std::vector<float> depth_;
  std::vector<LinearColor> color_;
};

/// Twice the area of (a, b, p): exactly the opposite for (b, a, p), so that two triangles leave no
/// crack between them. Positive where p is to the left of a -> b with y down.
double edge(const Vec3& a, const Vec3& b, double x, double y) {
  if (b.x < a.x || (b.x == a.x && b.y < a.y)) return -((a.x - b.x) * (y - b.y) - (a.y - b.y) * (x - b.x));
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

double side_length(const Vec3& a, const Vec3& b) { return std::hypot(b.x - a.x, b.y - a.y); }

void draw(const ScreenTriangle& t, double edge_width, Band& band) {
  const auto& [a, b, c] = t.corner;
  const double area = edge(a, b, c.x, c.y);
  if (area == 0 || !std::isfinite(area)) return;
  const double sign = area > 0 ? 1 : -1;
  const std::array<double, 3> side{side_length(b, c), side_length(c, a), side_length(a, b)};
  // Where a front and a back face meet, at the outline, the front one shall win.
  const double bias = t.front ? 0 : -1e-3;
  const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
  const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
  band.for_each_sample(x0, x1, y0, y1, [&](double x, double y, std::size_t sample) {
    const std::array<double, 3> w{sign * edge(b, c, x, y), sign * edge(c, a, x, y), sign * edge(a, b, x, y)};
    if (w[0] < 0 || w[1] < 0 || w[2] < 0) return;
    const double total = std::fabs(area);
    const auto blend = [&](double u, double v, double s) { return (w[0] * u + w[1] * v + w[2] * s) / total; };
    const double depth = blend(a.z, b.z, c.z) + bias;
    if (band.hides(sample, depth) || blend(t.clip[0], t.clip[1], t.clip[2]) > 0) return;
    double ink = 1;
    if (edge_width > 0)
      for (std::size_t k = 0; k < 3; ++k)
        if (w[k] < 0.5 * edge_width * side[k]) ink = 0.12;
    LinearColor color;
    for (std::size_t k = 0; k < 3; ++k)
      color[k] = static_cast<float>(ink * blend(t.color[0][k], t.color[1][k], t.color[2][k]));
    band.put(sample, depth, color);
  });
}

/// Numbers of the primitives that touch each band, in order.
struct Bins {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> items;

  /// span(i) gives the rows from and to in pixels.
  template <class Span>
  Bins(std::size_t count, std::uint32_t height, Span&& span) : begin((height + band_rows - 1) / band_rows + 1, 0) {
    const double last = static_cast<double>(begin.size() - 2);
    const auto for_each_entry = [&](auto&& visit) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto [from, to] = span(i);
        if (!(to >= 0 && from <= height)) continue;
        const auto first = static_cast<std::size_t>(std::clamp(from / band_rows, 0.0, last));
        const auto final = static_cast<std::size_t>(std::clamp(to / band_rows, 0.0, last));
        for (std::size_t b = first; b <= final; ++b) visit(b, i);
      }
    };
    for_each_entry([&](std::size_t b, std::uint32_t) { ++begin[b + 1]; });
    for (std::size_t b = 1; b < begin.size(); ++b) begin[b] += begin[b - 1];
    items.resize(begin.back());
    std::vector<std::size_t> place(begin.begin(), begin.end() - 1);
    for_each_entry([&](std::size_t b, std::uint32_t i) { items[place[b]++] = i; });
  }
};

/// draw_one(primitive, band) for all primitives of all bands.
template <class DrawOne>
Canvas draw_bands(const Bins& bins, std::uint32_t width, std::uint32_t height, const Threads& threads,
                  DrawOne&& draw_one) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  Canvas canvas{width, height, std::vector<LinearColor>(pixels), std::vector<float>(pixels),
                std::vector<float>(pixels, nothing)};
  threads.run(bins.begin.size() - 1, [&](std::size_t b) {
    if (bins.begin[b] == bins.begin[b + 1]) return;
    const auto first = static_cast<std::uint32_t>(b) * band_rows;
    Band band(width, first, std::min(first + band_rows, height));
    for (std::size_t k = bins.begin[b]; k < bins.begin[b + 1]; ++k) draw_one(bins.items[k], band);
    band.resolve(canvas);
  });
  return canvas;
}

} // namespace

Canvas draw_triangles(std::span<const ScreenTriangle> triangles, std::uint32_t width, std::uint32_t height,
                      double edge_width, const Threads& threads) {
  const Bins bins(triangles.size(), height, [&](std::uint32_t i) {
    const auto& c = triangles[i].corner;
    return std::pair<double, double>(std::minmax({c[0].y, c[1].y, c[2].y}));
  });
  return draw_bands(bins, width, height, threads,
                    [&](std::uint32_t i, Band& band) { draw(triangles[i], edge_width, band); });
}

Canvas draw_discs(std::span<const ScreenDisc> discs, std::uint32_t width, std::uint32_t height, double diameter,
                  const Threads& threads) {
  // Never so small that a disc falls between the samples.
  const double radius = std::max(diameter / 2, 0.75 / per_side);
  const Bins bins(discs.size(), height, [&](std::uint32_t i) {
    return std::pair{discs[i].centre.y - radius, discs[i].centre.y + radius};
  });
  return draw_bands(bins, width, height, threads, [&](std::uint32_t i, Band& band) {
    const Vec3& p = discs[i].centre;
    band.for_each_sample(p.x - radius, p.x + radius, p.y - radius, p.y + radius,
                         [&](double x, double y, std::size_t sample) {
                           const double dx = x - p.x, dy = y - p.y;
                           if (dx * dx + dy * dy > radius * radius || band.hides(sample, p.z)) return;
                           band.put(sample, p.z, discs[i].color);
                         });
  });
}

} // namespace eigencrust
