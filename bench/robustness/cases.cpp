// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases.h"

#include <algorithm>

#include <eigencrust/error.h>

#include "named_cases.h"
#include "sampling.h"

namespace eigencrust::bench {

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  add_outlier_cases(cases);
  add_bumpy_cases(cases);
  add_bunny_cases(cases);
  add_raw_cases(cases);
  add_missing_cases(cases);
  add_body_cases(cases);
  add_density_cases(cases);
  add_noise_cases(cases);
  add_field_cases(cases);
  add_open_field_cases(cases);
  add_real_field_cases(cases);
  return cases;
}

std::vector<Case> select_cases(std::vector<Case> cases, const std::vector<std::string>& patterns, bool quick) {
  keep_named(patterns, "--cases", cases);
  std::erase_if(cases, [quick](const Case& c) { return quick && c.large; });
  return cases;
}

RenderOptions view_of(const std::string& file) {
  RenderOptions view;
  view.width = view.height = 900;
  if (file.find("horse") != std::string::npos) {
    view.up = {0, 0, 1};
    view.azimuth = 110;
  } else if (file.find("armadillo") != std::string::npos) {
    view.azimuth = 150; // its face looks along +z in the model, its back is seen
  }
  return view;
}

} // namespace eigencrust::bench
