// SPDX-License-Identifier: GPL-3.0-or-later
#include <eigencrust/error.h>
#include <eigencrust/option_table.h>
#include <gmock/gmock.h>

#include <set>

namespace eigencrust {
namespace {

std::string refusal(const std::string& name, const std::string& value) {
  Options options;
  try {
    set_option(options, name, value);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return {};
}

TEST(OptionTable, ThePresetComesFirstAndNamesAreThereOnce) {
  EXPECT_EQ(option_table().front().name, "preset");
  std::set<std::string_view> names;
  for (const OptionEntry& entry : option_table()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_GT(entry.help.size(), 10u);
    EXPECT_NE(entry.help.back(), '.') << entry.name;
    EXPECT_EQ(entry.name.find('_'), std::string_view::npos);
  }
}

TEST(OptionTable, WhatIsReadCanBeSet) {
  for (const Preset preset : {Preset::robust, Preset::paper}) {
    const Options standard = Options::of(preset);
    Options again;
    for (const OptionEntry& entry : option_table())
      if (entry.get(standard) != "none") entry.set(again, entry.get(standard));
    for (const OptionEntry& entry : option_table()) EXPECT_EQ(entry.get(again), entry.get(standard)) << entry.name;
  }
}

TEST(OptionTable, EveryOptionChangesWhatItIsNamedAfter) {
  const std::vector<std::pair<std::string, std::string>> other{{"preset", "paper"},
                                                               {"method", "powercrust"},
                                                               {"noise", "0.5%"},
                                                               {"grid-spacing", "0.25"},
                                                               {"questionable", "never"},
                                                               {"weights", "paper"},
                                                               {"second-stage", "harmonic"},
                                                               {"eigensolver", "lanczos"},
                                                               {"tolerance", "1e-5"},
                                                               {"max-steps", "7"},
                                                               {"manifold", "off"},
                                                               {"components", "largest"},
                                                               {"outside-point", "1,2,3"},
                                                               {"inside-point", "4,5,6"},
                                                               {"crossing-depth", "0.5"},
                                                               {"facade", "+z"},
                                                               {"base", "on"},
                                                               {"trim", "on"},
                                                               {"surface", "fitted"},
                                                               {"smooth", "3"},
                                                               {"smoothing", "taubin"},
                                                               {"triangles", "1000"},
                                                               {"max-error", "0.5 sigma"},
                                                               {"edge", "0.1%"},
                                                               {"threads", "2"},
                                                               {"max-memory", "1000"},
                                                               {"point-results", "on"},
                                                               {"global-sign", "supernode"},
                                                               {"manifold-rule", "paper"},
                                                               {"stable-share", "0.5"}};
  std::set<std::string> tried;
  for (const auto& [name, value] : other) {
    Options options;
    set_option(options, name, value);
    for (const OptionEntry& entry : option_table()) {
      if (entry.name == name) {
        EXPECT_EQ(entry.get(options), value);
        EXPECT_NE(entry.get(options), entry.get(Options{})) << name;
      } else if (name != "preset") {
        EXPECT_EQ(entry.get(options), entry.get(Options{})) << name << " changed " << entry.name;
      }
    }
    tried.insert(name);
  }
  for (const OptionEntry& entry : option_table()) EXPECT_TRUE(tried.contains(std::string(entry.name))) << entry.name;
}

TEST(OptionTable, TheWordsOfAChoiceAreAcceptedAndNoOthers) {
  std::size_t with_words = 0;
  for (const OptionEntry& entry : option_table()) {
    const std::vector<std::string> words = choices(entry);
    for (const std::string& word : words) {
      Options options;
      EXPECT_NO_THROW(entry.set(options, word)) << entry.name;
      EXPECT_EQ(entry.get(options), word) << entry.name;
    }
    if (words.empty()) continue;
    ++with_words;
    EXPECT_FALSE(refusal(std::string(entry.name), words[0] + "x").empty()) << entry.name;
  }
  EXPECT_GE(with_words, 8u);
}

TEST(OptionTable, WhatIsOnTheCommandLineHasAChapter) {
  for (const OptionEntry& entry : option_table())
    EXPECT_EQ(chapter(entry.group).empty(), entry.group == OptionEntry::Group::library) << entry.name;
}

TEST(OptionTable, UnderscoresAreAsGoodAsDashes) {
  Options options;
  set_option(options, "grid_spacing", "2");
  EXPECT_EQ(to_string(options.grid_spacing), "2");
}

TEST(OptionTable, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal("nois", "off"), testing::AllOf(testing::HasSubstr("'nois'"), testing::HasSubstr("noise")));
  EXPECT_THAT(refusal("smooth", "many"), testing::HasSubstr("whole number"));
  EXPECT_THAT(refusal("smooth", "-1"), testing::HasSubstr("whole number"));
  EXPECT_THAT(refusal("tolerance", "small"), testing::HasSubstr("(0, 1)"));
  EXPECT_THAT(refusal("manifold", "perhaps"), testing::HasSubstr("on or off"));
  EXPECT_THAT(refusal("global-sign", "z"), testing::HasSubstr("vote, supernode"));
  EXPECT_THAT(refusal("manifold-rule", ""), testing::HasSubstr("cheapest, paper"));
  EXPECT_THAT(refusal("max-memory", "much"), testing::HasSubstr("much"));
}

TEST(OptionTable, PointsAddUpAndFacadesAreFoundOnlyByAuto) {
  Options options;
  set_option(options, "outside-point", "1,2,3");
  set_option(options, "outside-point", "4,5,6");
  EXPECT_EQ(options.outside_points.size(), 2u);
  set_option(options, "facade", "-x");
  EXPECT_FALSE(options.detect_facade);
  set_option(options, "facade", "auto");
  EXPECT_TRUE(options.detect_facade);
  EXPECT_FALSE(options.facade);
}

TEST(OptionTable, DefaultsForPeople) {
  for (const OptionEntry& entry : option_table()) {
    if (entry.name == "max-steps") {
      EXPECT_EQ(describe_default(entry), "60; paper: 300");
    }
    if (entry.name == "tolerance") {
      EXPECT_EQ(describe_default(entry), "1e-8; paper: 1e-6");
    }
    if (entry.name == "smooth") {
      EXPECT_EQ(describe_default(entry), "0");
    }
  }
}

} // namespace
} // namespace eigencrust
