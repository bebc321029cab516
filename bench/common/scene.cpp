// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.h"

#include <utility>

#include "sampling.h"

namespace eigencrust::bench {

Scene clean_scene(std::vector<Vec3> samples, Truth truth, unsigned threads) {
  Scene scene;
  scene.true_samples = samples.size();
  scene.spacing = median_spacing(samples, threads);
  scene.cloud.points = std::move(samples);
  scene.truth = std::move(truth);
  return scene;
}

} // namespace eigencrust::bench
