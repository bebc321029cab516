// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <eigencrust/options.h>
#include <gmock/gmock.h>

#include <functional>
#include <limits>

namespace eigencrust {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The remedy of the Error{usage} that `work` throws.
std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.remedy();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

template <class Value>
void expect_round_trip(const std::function<Value(const std::string&)>& parse,
                       const std::vector<std::pair<Value, std::string>>& names) {
  std::string accepted;
  for (const auto& [value, name] : names) {
    EXPECT_EQ(to_string(value), name);
    EXPECT_EQ(parse(name), value);
  }
  for (const std::string& wrong :
       {std::string(), std::string("nonsense"), names[0].second + " ", "X" + names[0].second}) {
    const std::string remedy = refusal([&] { parse(wrong); });
    for (const auto& [value, name] : names) EXPECT_THAT(remedy, testing::HasSubstr(name));
  }
}

TEST(Options, NamesGoThereAndBack) {
  expect_round_trip<Preset>(parse_preset, {{Preset::robust, "robust"}, {Preset::paper, "paper"}});
  expect_round_trip<Eigensolver>(parse_eigensolver,
                                 {{Eigensolver::multigrid, "multigrid"}, {Eigensolver::lanczos, "lanczos"}});
  expect_round_trip<SecondStage>(
      parse_second_stage,
      {{SecondStage::cut, "cut"}, {SecondStage::harmonic, "harmonic"}, {SecondStage::eigenvector, "eigenvector"}});
  expect_round_trip<Questionable>(
      parse_questionable,
      {{Questionable::before, "before"}, {Questionable::after, "after"}, {Questionable::never, "never"}});
  expect_round_trip<Smoothing>(parse_smoothing, {{Smoothing::laplacian, "laplacian"}, {Smoothing::taubin, "taubin"}});
  expect_round_trip<Axis>(parse_axis, {{Axis::plus_x, "+x"},
                                       {Axis::minus_x, "-x"},
                                       {Axis::plus_y, "+y"},
                                       {Axis::minus_y, "-y"},
                                       {Axis::plus_z, "+z"},
                                       {Axis::minus_z, "-z"}});
  EXPECT_EQ(to_string(GlobalSign::vote), "vote");
  EXPECT_EQ(to_string(GlobalSign::supernode), "supernode");
  EXPECT_EQ(to_string(ManifoldRule::cheapest), "cheapest");
  EXPECT_EQ(to_string(ManifoldRule::paper), "paper");
}

TEST(Options, LengthChoice) {
  using Kind = LengthChoice::Kind;
  const auto expect = [](const std::string& text, Kind kind, double value) {
    const LengthChoice spacing = parse_length_choice("grid spacing", text);
    EXPECT_EQ(spacing.kind, kind) << text;
    EXPECT_EQ(spacing.value, value) << text;
    EXPECT_EQ(parse_length_choice("noise", to_string(spacing)).value, value) << text;
    EXPECT_EQ(parse_length_choice("noise", to_string(spacing)).kind, kind) << text;
  };
  expect("auto", Kind::automatic, 0);
  expect("off", Kind::off, 0);
  expect("0.0007", Kind::length, 0.0007);
  expect("+2", Kind::length, 2);
  expect("1e-3", Kind::length, 1e-3);
  expect("0.1", Kind::length, 0.1);
  expect("2.5%", Kind::percent, 2.5);
  for (const char* wrong : {"", "%", "0", "0%", "-1", "-1%", "nan", "inf", "1mm", "1 ", " 1", "1%%", "++1", "AUTO"})
    EXPECT_THAT(refusal([&] { parse_length_choice("noise", wrong); }), testing::HasSubstr("auto")) << wrong;
}

TEST(Options, Components) {
  using Kind = KeepComponents::Kind;
  EXPECT_EQ(parse_components("supported").kind, Kind::supported);
  EXPECT_EQ(parse_components("all").kind, Kind::all);
  EXPECT_EQ(parse_components("largest").kind, Kind::largest);
  EXPECT_EQ(parse_components("17").kind, Kind::count);
  EXPECT_EQ(parse_components("17").count, 17u);
  for (const char* text : {"supported", "all", "largest", "17"}) EXPECT_EQ(to_string(parse_components(text)), text);
  for (const char* wrong : {"", "0", "-1", "+1", "1.5", "3x", "4294967296", "some"})
    EXPECT_THAT(refusal([&] { parse_components(wrong); }), testing::HasSubstr("largest")) << wrong;
}

TEST(Options, Points) {
  EXPECT_EQ(parse_point("1,-2.5,+3e2"), (Vec3{1, -2.5, 300}));
  for (const char* wrong :
       {"", "1", "1,2", "1,2,", ",1,2", "1,2,3,4", "1,2,nan", "1,inf,3", "1, 2,3", "a,b,c", "1;2;3"})
    EXPECT_THAT(refusal([&] { parse_point(wrong); }), testing::HasSubstr("x,y,z")) << wrong;
}

TEST(Options, CrossingDepth) {
  EXPECT_EQ(parse_crossing_depth("auto"), std::nullopt);
  EXPECT_EQ(parse_crossing_depth("0"), 0.0);
  EXPECT_EQ(parse_crossing_depth("2.5e-3"), 2.5e-3);
  for (const char* wrong : {"", "-1", "nan", "inf", "1mm", "1%", "off", "AUTO"})
    EXPECT_THAT(refusal([&] { parse_crossing_depth(wrong); }), testing::HasSubstr("auto")) << wrong;
}

TEST(Options, DefaultsAndPresetsAreInRange) {
  check_options({});
  check_options(Options::of(Preset::robust));
  check_options(Options::of(Preset::paper));
  EXPECT_EQ(Options::of(Preset::robust).preset, Preset::robust);
}

TEST(Options, ThePapersPresetIsThePaper) {
  const Options paper = Options::of(Preset::paper);
  EXPECT_EQ(paper.preset, Preset::paper);
  EXPECT_EQ(paper.second_stage, SecondStage::eigenvector);
  EXPECT_EQ(paper.questionable, Questionable::after);
  EXPECT_EQ(paper.global_sign, GlobalSign::supernode);
  EXPECT_TRUE(paper.manifold);
  EXPECT_EQ(paper.manifold_rule, ManifoldRule::paper);
  EXPECT_EQ(paper.components.kind, KeepComponents::Kind::all);
  EXPECT_EQ(paper.smooth, 0u);
}

using Change = std::function<void(Options&)>;

void expect_refused(const std::vector<Change>& changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Options options;
    changes[i](options);
    EXPECT_NE(refusal([&] { check_options(options); }), "") << "change " << i;
  }
}

TEST(Options, WhatIsOutOfRangeIsRefused) {
  expect_refused({
      [](Options& o) {
        o.grid_spacing = {LengthChoice::Kind::length, 0};
      },
      [](Options& o) {
        o.grid_spacing = {LengthChoice::Kind::length, -1};
      },
      [](Options& o) {
        o.grid_spacing = {LengthChoice::Kind::percent, nan};
      },
      [](Options& o) {
        o.grid_spacing = {LengthChoice::Kind::percent, infinity};
      },
      [](Options& o) {
        o.noise = {LengthChoice::Kind::length, 0};
      },
      [](Options& o) {
        o.noise = {LengthChoice::Kind::percent, nan};
      },
      [](Options& o) {
        o.components = {KeepComponents::Kind::count, 0};
      },
      [](Options& o) { o.solver.tolerance = 0; },
      [](Options& o) { o.solver.tolerance = 1; },
      [](Options& o) { o.solver.tolerance = nan; },
      [](Options& o) { o.solver.stable_share = 0; },
      [](Options& o) { o.solver.stable_share = 1.5; },
      [](Options& o) { o.solver.stable_share = nan; },
      [](Options& o) { o.solver.max_steps = 0; },
      [](Options& o) { o.crossing_depth = -1; },
      [](Options& o) { o.crossing_depth = nan; },
      [](Options& o) { o.crossing_depth = infinity; },
      [](Options& o) { o.smooth = 1001; },
      [](Options& o) { o.threads = 1025; },
      [](Options& o) {
        o.outside_points = {{0, nan, 0}};
      },
      [](Options& o) {
        o.inside_points = {{0, 0, 0}, {infinity, 0, 0}};
      },
  });
}

TEST(Options, WhatIsOutOfRangeForOtherTrianglesIsRefused) {
  expect_refused({
      [](Options& o) {
        o.max_error = {SurfaceLength::Kind::percent, 0};
      },
      [](Options& o) {
        o.edge = {SurfaceLength::Kind::length, nan};
      },
      [](Options& o) {
        o.edge = {SurfaceLength::Kind::length, 1};
        o.triangles = 10;
      },
      [](Options& o) {
        o.triangles = 10;
        o.manifold = false;
      },
      [](Options& o) {
        o.triangles = 10;
        o.method = Method::powercrust;
      },
  });
}

TEST(Options, LengthsOfTheResultAreReadInThreeUnits) {
  const auto length = [](const char* text) { return parse_surface_length("length", text); };
  EXPECT_EQ(length("off").resolve(100, 3), 0);
  EXPECT_EQ(length("0.5").resolve(100, 3), 0.5);
  EXPECT_EQ(length("0.5%").resolve(100, 3), 0.5);
  EXPECT_EQ(length("0.5 sigma").resolve(100, 3), 1.5);
  EXPECT_EQ(length("2sigma").resolve(100, 3), 6);
  for (const char* text : {"off", "0.5", "0.5%", "0.5 sigma"}) EXPECT_EQ(to_string(length(text)), text);
  for (const char* text : {"", "auto", "0", "-1", "sigma", "1 mm", "nan", "1% sigma"})
    EXPECT_NE(refusal([&] { length(text); }), "") << text;
}

TEST(Options, LimitsAreInRange) {
  Options options;
  options.solver.stable_share = 1;
  options.solver.max_steps = 1;
  options.smooth = 1000;
  options.threads = 1024;
  options.components = {KeepComponents::Kind::count, 1};
  check_options(options);
}

} // namespace
} // namespace eigencrust
