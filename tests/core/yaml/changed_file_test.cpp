#include "core/yaml/changed_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/yaml/yaml_map.h"
#include "tests/complaint.h"

namespace understudy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST(ChangedFile, IsTheFileAndItsChangesInTheirOrder) {
  const ChangedFile changed = changed_file("models/arm/machine.yaml{gap.aim_mm: 0.14, axes.2.play_um: 30}");
  EXPECT_EQ(changed.file, "models/arm/machine.yaml");
  EXPECT_THAT(changed.changes, ElementsAre(Pair("gap.aim_mm", "0.14"), Pair("axes.2.play_um", "30")));
  EXPECT_EQ(changed.braces(), "{gap.aim_mm: 0.14, axes.2.play_um: 30}");
}

TEST(ChangedFile, IsTheWordWhereThereAreNoBraces) {
  for (const char* word : {"hexapod", "a/b.yaml", "odd{name", ""}) {
    EXPECT_EQ(changed_file(word).file, word);
    EXPECT_EQ(changed_file(word).braces(), "");
  }
}

TEST(ChangedFile, TakesAnotherValueOfAKeyThatIsChangedAlready) {
  EXPECT_EQ(with_change("hexapod", "gap.aim_mm", "0.14"), "hexapod{gap.aim_mm: 0.14}");
  EXPECT_EQ(with_change("hexapod{gap.aim_mm: 0.14}", "gap.aim_mm", "0.15"), "hexapod{gap.aim_mm: 0.15}");
  EXPECT_EQ(with_change("hexapod{a: 1}", "b", "2"), "hexapod{a: 1, b: 2}");
}

TEST(ChangedFile, RefusesWhatIsNoValue) {
  EXPECT_THAT(complaint([] { changed_file("m{a: [1, 2]}"); }), HasSubstr("a value is a number or a word"));
  EXPECT_THAT(complaint([] { changed_file("m{a: 1, a: 2}"); }), HasSubstr("a is changed twice"));
  EXPECT_THAT(complaint([] { changed_file("m{a: ../b}"); }), HasSubstr("is no key and value"));
  EXPECT_THAT(complaint([] { changed_file("m{1 2 3}"); }),
              HasSubstr("changed values are told as FILE{key: value, ...}"));
}

constexpr const char* kText =
    "# a machine, play in \u00b5m\naxes:\n  - {name: j1, play_um: 10}  # turns\n  - {name: j2, play_um: "
    "20}\ngap:\n  aim_mm: "
    "0.13\n";

std::string text_with(const std::string& changes) {
  return changed_text(kText, changed_file("m.yaml{" + changes + "}"), "m.yaml");
}

TEST(ChangedText, HoldsTheValuesAndEverythingElseAsItWas) {
  EXPECT_EQ(text_with("axes.j1.play_um: 15, gap.aim_mm: 0.1456, axes.2.play_um: 7"),
            "# a machine, play in \u00b5m\naxes:\n  - {name: j1, play_um: 15}  # turns\n  - {name: j2, "
            "play_um: 7}\ngap:\n  "
            "aim_mm: 0.1456\n");
}

TEST(ChangedText, GainsASectionThatWasNotThere) {
  EXPECT_EQ(text_with("gap_control.approach.step_fraction: 0.4"),
            std::string(kText) + "gap_control:\n  approach:\n    step_fraction: 0.4\n");
}

TEST(ChangedText, RefusesWhatItCouldOnlyGuessAt) {
  EXPECT_THAT(complaint([] { text_with("gap.floor_mm: 0.1"); }),
              HasSubstr("m.yaml: gap.floor_mm: does not stand in the file, so it cannot be written there"));
  EXPECT_THAT(complaint([] { text_with("gap: 0.1"); }),
              HasSubstr("gap: is no plain word or number in the file"));
  EXPECT_THAT(complaint([] { text_with("axes.3.play_um: 1"); }), HasSubstr("item 3 is outside 1..2"));
}

/// What a reader finds of a file whose word changes values.
struct Found {
  double aim = 0, second = 0, play = 0;
  std::string error;
};

Found read(const std::string& changes) {
  const std::string text =
      "gap: {aim_mm: 0.13}\ncentre_px: [1, 2]\naxes:\n  - {name: a, play_um: 1}\n  - {name: b, play_um: 2}\n";
  Found found;
  found.error = complaint([&] {
    YamlMap::read_text(text, "m.yaml" + changes, [&](YamlMap& map) {
      map.section("gap", "g", [&](YamlMap& gap) { found.aim = gap.number("aim_mm", {0.1, 0.2}, "a"); });
      found.second = map.numbers("centre_px", 2, {}, "c")[1];
      map.list("axes", 2, "x", [&](YamlMap& axis, std::size_t i) {
        axis.text("name", "n");
        const double play = axis.number("play_um", {}, "p");
        if (i == 1) found.play = play;
      });
    });
  });
  return found;
}

TEST(ChangedFile, ValuesAreReadAsChanged) {
  EXPECT_EQ(read("").aim, 0.13);
  EXPECT_EQ(read("{gap.aim_mm: 0.15}").aim, 0.15);
  EXPECT_EQ(read("{centre_px.2: 7}").second, 7);
  EXPECT_EQ(read("{axes.2.play_um: 40}").play, 40);
  EXPECT_EQ(read("{axes.b.play_um: 50}").play, 50);
}

TEST(ChangedFile, AnUnknownKeyIsRefusedWithTheNearestOne) {
  EXPECT_THAT(read("{gap.aim_m: 0.15}").error, HasSubstr("unknown key 'gap.aim_m', did you mean 'aim_mm'?"));
  EXPECT_THAT(read("{gapp.aim_mm: 0.15}").error, HasSubstr("unknown key 'gapp', did you mean 'gap'?"));
  EXPECT_THAT(read("{axes.c.play_um: 1}").error,
              HasSubstr("no item of the list is named 'c'; its items are 1..2 or a, b"));
  EXPECT_THAT(read("{axes.3.play_um: 1}").error, HasSubstr("item 3 is outside 1..2"));
  EXPECT_THAT(read("{gap.aim_mm.x: 1}").error, HasSubstr("'x' is below a value, where no key is"));
}

TEST(ChangedFile, AValueBeyondItsLimitsIsRefusedWithTheWord) {
  EXPECT_THAT(read("{gap.aim_mm: 0.3}").error,
              HasSubstr("m.yaml{gap.aim_mm: 0.3}:1:15: gap.aim_mm is 0.3 mm, outside 0.1 to 0.2 mm"));
}

}  // namespace
}  // namespace understudy
