#include "core/yaml/yaml_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What the reader says of the text: "f.yaml:2:1: ...".
std::string refusal(const std::string& text, const YamlMap::Read& read) {
  try {
    YamlMap::read_text(text, "f.yaml", read);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

void read_lead(YamlMap& map) { map.quantity("lead_mm", {0.1, 100}, ""); }

TEST(YamlMap, QuantitiesAreSiByTheSuffixOfTheirKey) {
  YamlMap::read_text("a_mm: 2\nb_deg: 180\nc_um: [1, 2]\nd_s: 3\ne: 7\n", "f.yaml", [](YamlMap& map) {
    EXPECT_DOUBLE_EQ(map.quantity("a_mm", {}, ""), 2e-3);
    EXPECT_DOUBLE_EQ(map.quantity("b_deg", {}, ""), 3.141592653589793);
    EXPECT_EQ(map.quantities("c_um", 2, {}, ""), (std::vector<double>{1e-6, 2e-6}));
    EXPECT_EQ(map.quantity("d_s", {}, ""), 3);
    EXPECT_EQ(map.number("e", {}, ""), 7);
  });
}

TEST(YamlMap, NumbersAreAsTheFileHasThem) {
  YamlMap::read_text("a_mm: +2.5\nb_mm: [1e-3, -.5]\nseed: 18446744073709551615\n", "f.yaml",
                     [](YamlMap& map) {
                       EXPECT_EQ(map.number("a_mm", {}, ""), 2.5);
                       EXPECT_EQ(map.numbers("b_mm", 2, {}, ""), (std::vector<double>{1e-3, -0.5}));
                       EXPECT_EQ(map.seed("seed", ""), UINT64_MAX);
                     });
}

TEST(YamlMap, ListsOfWordsAreAsWrittenAndOneWordIsAList) {
  YamlMap::read_text("a: [x y, 2, \"3\"]\nb: one\n", "f.yaml", [](YamlMap& map) {
    EXPECT_EQ(map.texts("a", ""), (std::vector<std::string>{"x y", "2", "3"}));
    EXPECT_EQ(map.texts("b", ""), std::vector<std::string>{"one"});
  });
  for (const char* text : {"a: []\n", "a: {b: 1}\n", "a: [[1]]\n"})
    EXPECT_THAT(refusal(text, [](YamlMap& map) { map.texts("a", ""); }), HasSubstr("f.yaml:1:1: a ")) << text;
}

TEST(YamlMap, WhatIsNoFiniteNumberWithinItsBoundsIsRefused) {
  EXPECT_EQ(refusal("lead_mm: 0\n", read_lead), "f.yaml:1:10: lead_mm is 0 mm, outside 0.1 to 100 mm");
  EXPECT_EQ(refusal("t_s: -1\n", [](YamlMap& map) { map.number("t_s", {0}, ""); }),
            "f.yaml:1:6: t_s is -1 s, below 0 s");
  for (const char* value : {"small", "1mm", "0x10", "1,5", "''", "[1]", "{a: 1}", "", "~"})
    EXPECT_THAT(refusal("lead_mm: " + std::string(value), read_lead),
                HasSubstr("where a number in mm is expected"))
        << value;
  EXPECT_THAT(refusal("lead_mm: \"1\"", read_lead),
              HasSubstr("'1' in quotes, where a number in mm is expected"));
  for (const char* value : {".nan", "nan", ".inf", "-.inf", "inf", "1e999"})
    EXPECT_THAT(refusal("lead_mm: " + std::string(value), read_lead), HasSubstr("not finite")) << value;
  for (const char* value : {"-1", "1.5", "18446744073709551616", "x"})
    EXPECT_THAT(refusal("seed: " + std::string(value), [](YamlMap& map) { map.seed("seed", ""); }),
                HasSubstr("where a whole number from 0"))
        << value;
}

TEST(YamlMap, AKeyThatNobodyAskedForNamesTheNearest) {
  const auto read = [](YamlMap& map) {
    map.section("drive", "", [](YamlMap& drive) {
      read_lead(drive);
      drive.has("jump");
    });
  };
  EXPECT_EQ(refusal("drive:\n  lead_m: 1\n", read),
            "f.yaml:2:3: unknown key 'drive.lead_m', did you mean 'lead_mm'?");
  EXPECT_EQ(refusal("drive: {lead_mm: 1, zzz: 2}\n", read),
            "f.yaml:1:21: unknown key 'drive.zzz'; known here: lead_mm, jump");
  EXPECT_EQ(refusal("drive: {jump: 1}\n", read), "f.yaml:1:8: key 'drive.lead_mm' is missing");
  EXPECT_EQ(refusal("drive: {lead_mm: 1, jump: 1, jump: 2}\n", read),
            "f.yaml:1:30: drive.jump is given twice, first in line 1");
}

TEST(YamlMap, ARequiredKeyIsMissedAtOnceUnlessAMisspeltOneExplainsIt) {
  const auto read = [](YamlMap& map) {
    map.require("kind");
    FAIL() << "went on without its kind";
  };
  EXPECT_EQ(refusal("other: 1\n", read), "f.yaml:1:1: key 'kind' is missing");
  EXPECT_THAT(refusal("\nkid: 1\n", read), HasSubstr("f.yaml:2:1: unknown key 'kid'"));
}

TEST(YamlMap, WordsNameTheAllowedOnesAndTheNearest) {
  const auto read = [](YamlMap& map) { map.word("plant", {"mujoco", "bullet"}, ""); };
  EXPECT_EQ(refusal("plant: mojoco\n", read),
            "f.yaml:1:1: plant is 'mojoco', not one of mujoco, bullet; did you mean 'mujoco'?");
  EXPECT_EQ(refusal("plant: x\n", read), "f.yaml:1:1: plant is 'x', not one of mujoco, bullet");
}

// Escapes make what the file itself may not have.
TEST(YamlMap, ANameIsOneLineWithoutControlCharacters) {
  const auto name = [](YamlMap& map) { map.name("about", ""); };
  EXPECT_EQ(refusal("about: a name\n", name), "accepted");
  EXPECT_EQ(refusal("about: \"two\\nlines\"\n", name),
            "f.yaml:1:1: about is 'two\\nlines': a name is one line without control characters");
  for (const char* escape : {"\\e[31m", "\\t", "\\x7f", "\\r"})
    EXPECT_THAT(refusal(std::string("about: \"") + escape + "\"\n", name), HasSubstr("a name is one line"))
        << escape;
}

TEST(YamlMap, ListsNumberTheirEntries) {
  const auto read = [](YamlMap& map) {
    map.list("axes", 0, "", [](YamlMap& axis, std::size_t) { axis.text("name", ""); });
  };
  EXPECT_EQ(refusal("axes: [{name: a}, {nam: b}]\n", read),
            "f.yaml:1:20: unknown key 'axes[2].nam', did you mean 'name'?");
  EXPECT_EQ(refusal("axes: []\n", read),
            "f.yaml:1:1: axes is an empty list, where a list with at least one entry is expected");
}

TEST(YamlMap, AnEmptyValueIsReportedWhereItsKeyStands) {
  const auto refused_by = [](const char* text, const YamlMap::Read& read) {
    return refusal(std::string("first: 1\n") + text + "\n\nlast: 1\n", [&](YamlMap& map) {
      map.number("first", {}, "");
      read(map);
      map.number("last", {}, "");
    });
  };
  const YamlMap::Read lead = [](YamlMap& map) { read_lead(map); };
  EXPECT_EQ(refused_by("lead_mm:", lead), "f.yaml:2:1: lead_mm is empty, where a number in mm is expected");
  EXPECT_EQ(refused_by("lead_mm: ~", lead), "f.yaml:2:1: lead_mm is empty, where a number in mm is expected");
  EXPECT_THAT(refused_by("n:", [](YamlMap& map) { map.integer("n", 0, 9, ""); }), HasSubstr("f.yaml:2:1: n"));
  EXPECT_THAT(refused_by("n:", [](YamlMap& map) { map.seed("n", ""); }), HasSubstr("f.yaml:2:1: n is empty"));
  EXPECT_THAT(refused_by("n:", [](YamlMap& map) { map.text("n", ""); }), HasSubstr("f.yaml:2:1: n is empty"));
  EXPECT_THAT(refused_by("n:", [](YamlMap& map) { map.numbers("n", 2, {}, ""); }),
              HasSubstr("f.yaml:2:1: n is empty, where a list of 2 numbers"));
  EXPECT_THAT(refused_by("n:\n  - 1\n  -", [](YamlMap& map) { map.numbers("n", 2, {}, ""); }),
              HasSubstr("f.yaml:2:1: n is empty, where a number is expected"));
  const YamlMap::Read section = [](YamlMap& map) { map.section("drive", "", read_lead); };
  EXPECT_EQ(refused_by("drive:", section), "f.yaml:2:1: drive is empty, where keys with values are expected");
  EXPECT_EQ(refused_by("drive:\n  lead_mm:", section),
            "f.yaml:3:3: drive.lead_mm is empty, where a number in mm is expected");
  const YamlMap::Read list = [](YamlMap& map) {
    map.list("axes", 0, "", [](YamlMap& axis, std::size_t) { read_lead(axis); });
  };
  EXPECT_THAT(refused_by("axes:", list), HasSubstr("f.yaml:2:1: axes is empty"));
  EXPECT_EQ(refused_by("axes:\n  - lead_mm: 1\n  -", list),
            "f.yaml:2:1: axes[2] is empty, where keys with values are expected");
  EXPECT_EQ(refusal("---\n", lead), "f.yaml: the file is empty, where keys with values are expected");
}

TEST(YamlMap, AFileThatHoldsNoMapIsRefused) {
  const auto read = [](YamlMap&) {};
  EXPECT_THAT(refusal("", read), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("words\n", read),
              HasSubstr("the file is 'words', where keys with values are expected"));
  EXPECT_THAT(refusal("a: 1\n---\na: 1\n", read), HasSubstr("2 documents, 1 is allowed"));
  EXPECT_THAT(refusal("a: [1, 2\n", read), AllOf(HasSubstr("f.yaml:2:1"), HasSubstr("not YAML")));
  EXPECT_THAT(refusal(", 0]\na: 1\n", read), HasSubstr("closed twice"));
}

TEST(YamlMap, WhatAliasesRepeatIsCounted) {
  // 100 words, 100 times each, and so on: a million in 1 kB, each of which a reader may copy.
  std::string text = "a: &a [" + repeated("x, ", 99) + "x]\nb: &b [" + repeated("*a, ", 99) + "*a]\n";
  EXPECT_THAT(refusal(text, [](YamlMap& map) { EXPECT_EQ(map.texts("a", "").size(), 100u); }),
              HasSubstr("unknown key 'b'"));
  text += "c: [" + repeated("*b, ", 99) + "*b]\n";
  EXPECT_THAT(refusal(text, [](YamlMap&) {}),
              AllOf(HasSubstr("f.yaml:3:"), HasSubstr("more than 1000000 values")));
}

TEST(YamlMap, WhatAliasesRepeatOfALongWordIsCounted) {
  const std::string text = "a: &a " + std::string(640'000, 'x') + "\nb: [" + repeated("*a, ", 99) + "*a]\n";
  EXPECT_THAT(refusal(text, [](YamlMap&) {}),
              AllOf(HasSubstr("f.yaml:2:"), HasSubstr("more than 1000000 values")));
}

TEST(YamlMap, AnAliasWithinItsOwnValueIsRefused) {
  EXPECT_THAT(refusal("a: &a [1, *a]\n", [](YamlMap&) {}),
              AllOf(HasSubstr("f.yaml:1:11: "), HasSubstr("an alias stands within the value that it names")));
}

TEST(YamlMap, LookingBelowDoesNotAddOrAskForTheKey) {
  EXPECT_EQ(refusal("tool: {mill: 1}\n",
                    [](YamlMap& map) {
                      EXPECT_TRUE(map.has("tool.mill"));
                      EXPECT_FALSE(map.has("tool.bore"));
                      EXPECT_FALSE(map.has("none.bore"));
                      map.section("tool", "", [](YamlMap& tool) { tool.number("mill", {}, ""); });
                    }),
            "accepted");
}

}  // namespace
}  // namespace understudy
