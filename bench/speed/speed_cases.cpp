// SPDX-License-Identifier: GPL-3.0-or-later
#include "speed_cases.h"

#include <algorithm>
#include <sstream>

#include <eigencrust/error.h>
#include <eigencrust/io.h>
#include <eigencrust/metrics.h>

#include "bodies.h"
#include "degradations.h"
#include "sampling.h"

namespace eigencrust::bench {

std::vector<SpeedCase> speed_cases(const std::vector<std::size_t>& sizes, const std::vector<std::string>& patterns) {
  std::vector<SpeedCase> cases{{"bunny", "bunny/bunny_raw.ply", 0},
                               {"dragon", "dragon/dragon_stand_side_raw.ply", 0},
                               {"happy", "happy/happy_stand_side_raw.ply", 0}};
  for (const std::size_t size : sizes) cases.push_back({"sphere-" + std::to_string(size), "", size});
  std::vector<std::string> wanted;
  for (const std::string& list : patterns) {
    std::istringstream stream(list);
    for (std::string pattern; std::getline(stream, pattern, ',');)
      if (!pattern.empty()) wanted.push_back(pattern);
  }
  const auto fits = [](const SpeedCase& c, const std::string& p) { return c.name.find(p) != std::string::npos; };
  for (const std::string& pattern : wanted)
    if (std::none_of(cases.begin(), cases.end(), [&](const SpeedCase& c) { return fits(c, pattern); }))
      throw Error(ErrorKind::usage, "--clouds", "no cloud fits '" + pattern + "'",
                  "take bunny, dragon, happy, sphere or sphere-SIZE");
  std::erase_if(cases, [&](const SpeedCase& c) {
    return !wanted.empty() &&
           std::none_of(wanted.begin(), wanted.end(), [&](const std::string& p) { return fits(c, p); });
  });
  return cases;
}

void write_noisy_sphere(std::size_t count, const std::filesystem::path& path) {
  constexpr std::uint64_t seed = 1;
  PointCloud cloud;
  cloud.points = sample_surface(*bumpy_sphere().mesh, count, seed);
  for (Vec3& p : cloud.points) p = on_bumpy_sphere(p);
  add_noise(cloud.points, 0.5 * median_spacing(cloud.points, 0), seed);
  write_point_cloud(path, cloud);
}

} // namespace eigencrust::bench
