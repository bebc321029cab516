// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/eigencrust.h>

#include "bindings.h"

PYBIND11_MODULE(_core, module) {
  using namespace eigencrust::python;
  module.doc() = "What eigencrust is made of in C++. Use the package eigencrust, which checks what it is given.";
  module.attr("version") = eigencrust::version();
  bind_errors();
  bind_clouds(module);
  bind_options(module);
  bind_files(module);
  bind_metrics(module);
  bind_pictures(module);
  auto stages = module.def_submodule("stages", "Every step of the method.");
  bind_stage_types(stages);
  bind_reconstruct(module);
  bind_stages(stages);
}
