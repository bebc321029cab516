// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <eigencrust/option_table.h>

#include "bindings.h"

namespace eigencrust::python {
namespace {

const char* kind_name(OptionEntry::Kind kind) {
  switch (kind) {
    case OptionEntry::Kind::choice:
      return "choice";
    case OptionEntry::Kind::length:
      return "length";
    case OptionEntry::Kind::number:
      return "number";
    case OptionEntry::Kind::count:
      return "count";
    case OptionEntry::Kind::flag:
      return "flag";
    case OptionEntry::Kind::points:
      return "points";
    case OptionEntry::Kind::bytes:
      return "bytes";
  }
  return "?";
}

/// (name, kind, help, default of the preset robust, default of the preset paper) of each option.
py::list table() {
  py::list rows;
  const Options robust = Options::of(Preset::robust), paper = Options::of(Preset::paper);
  for (const OptionEntry& entry : option_table())
    rows.append(py::make_tuple(std::string(entry.name), kind_name(entry.kind), std::string(entry.help),
                               entry.get(robust), entry.get(paper)));
  return rows;
}

void add_points(Options& options, const std::string& name, const py::object& points) {
  std::vector<Vec3>& all = name == "outside-point" ? options.outside_points : options.inside_points;
  const std::vector<Vec3> more = to_optional_points(points, name.c_str());
  all.insert(all.end(), more.begin(), more.end());
}

std::string get(const Options& options, const std::string& name) {
  for (const OptionEntry& entry : option_table())
    if (entry.name == name) return entry.get(options);
  throw py::key_error(name);
}

} // namespace

void bind_options(py::module_& module) {
  py::class_<Options>(module, "Options")
      .def(py::init<>())
      .def("set", [](Options& options, const std::string& name,
                     const std::string& value) { set_option(options, name, value); })
      .def("add_points", add_points)
      .def("get", get)
      .def("check", check_options);
  module.def("option_table", table);
}

} // namespace eigencrust::python
