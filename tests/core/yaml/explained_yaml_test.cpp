#include "core/yaml/explained_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/yaml/yaml_map.h"

namespace understudy {
namespace {

using testing::HasSubstr;
using testing::Not;

void read(YamlMap& root) {
  root.text("name", "shown in reports");
  root.section("geometry", "as drawn", [](YamlMap& map) {
    map.vector("tip_mm", {-5000, 5000}, "where the tip is");
  });
  root.list("axes", 0, "one by one", [](YamlMap& map, std::size_t) {
    map.text("name", "of the axis");
    map.section("drive", "motor and gear", [](YamlMap& drive) {
      drive.quantity("lead_mm", {0.1, 100}, "travel in a turn");
    });
  });
}

constexpr const char* kText = R"(# yaml-language-server: $schema=machine.json
# A machine.
name: 'a # b'   # of the shop
geometry: {tip_mm: [1, 2, 3]}
axes:
  # The first.
  - {name: x, drive: {lead_mm: 8}}   # measured
  - {name: y, drive: {lead_mm: 2}}
)";

std::string explained() {
  return explained_yaml(kText, YamlMap::schema(read), [](const std::string& path) {
    return path == "axes.drive.lead_mm" ? "assumed" : "";
  });
}

TEST(ExplainedYaml, EveryKeyHasItsMeaningUnitMarkAndOldComment) {
  const std::string text = explained();
  for (const char* line : {"# A machine.\n", "# shown in reports; of the shop\n", "tip_mm: [1, 2, 3]",
                           "# where the tip is; mm\n", "    # The first.\n  - name: x",
                           "# of the axis; measured\n", "lead_mm: 8", "# travel in a turn; mm; assumed\n"})
    EXPECT_THAT(text, HasSubstr(line)) << text;
  EXPECT_THAT(text, Not(HasSubstr("$schema")));
}

TEST(ExplainedYaml, ReadsBackAsTheSameValues) {
  std::string name;
  std::vector<double> leads;
  Vec3 tip;
  YamlMap::read_text(explained(), "explained.yaml", [&](YamlMap& root) {
    name = root.text("name", "");
    root.section("geometry", "", [&](YamlMap& map) { tip = map.vector("tip_mm", {-5000, 5000}, ""); });
    root.list("axes", 0, "", [&](YamlMap& map, std::size_t) {
      map.text("name", "");
      map.section("drive", "", [&](YamlMap& drive) {
        leads.push_back(drive.quantity("lead_mm", {0.1, 100}, ""));
      });
    });
  });
  EXPECT_EQ(name, "a # b");
  EXPECT_EQ(tip, Vec3(0.001, 0.002, 0.003));
  EXPECT_THAT(leads, testing::ElementsAre(0.008, 0.002));
}

TEST(ExplainedYaml, WhatIsNoMapIsRefused) {
  const auto none = [](const std::string&) { return std::string(); };
  EXPECT_THROW(explained_yaml("[1, 2]", {}, none), InputError);
  EXPECT_THROW(explained_yaml("a: [1", {}, none), InputError);
}

}  // namespace
}  // namespace understudy
