#include "report/json_schema.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/yaml/yaml_map.h"

namespace understudy::report {
namespace {

using nlohmann::json;

json written(const YamlMap::Read& read) { return json::parse(json_schema(YamlMap::schema(read), "title")); }

TEST(JsonSchema, TellsTypeRangeUnitAndMeaning) {
  const json schema = written([](YamlMap& map) {
    map.quantity("lead_mm", {0.1, 100}, "travel of one turn");
    if (map.has("steps")) map.integer("steps", 1, 200, "of the motor");
  });
  EXPECT_EQ(schema["properties"]["lead_mm"], json::parse(R"({"type": "number", "minimum": 0.1, "maximum": 100,
                            "description": "travel of one turn [mm]"})"));
  EXPECT_EQ(schema["properties"]["steps"]["type"], "integer");
  EXPECT_EQ(schema["required"], json::parse(R"(["lead_mm"])"));
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_FALSE(schema.contains("allOf"));
}

TEST(JsonSchema, AWordAllowsItsKeysOnly) {
  const json schema = written([](YamlMap& map) {
    if (map.word("shape", {"ball", "box", "cube"}, "") == "ball") map.number("radius", {}, "");
  });
  EXPECT_EQ(schema["properties"]["shape"]["enum"], json::parse(R"(["ball", "box", "cube"])"));
  ASSERT_EQ(schema["allOf"].size(), 2u);
  EXPECT_EQ(schema["allOf"][0],
            json::parse(R"({"if": {"properties": {"shape": {"enum": ["ball"]}}, "required": ["shape"]},
                                                "then": {"required": ["radius"]}})"));
  EXPECT_EQ(schema["allOf"][1], json::parse(R"({"if": {"properties": {"shape": {"enum": ["box", "cube"]}},
                                                        "required": ["shape"]},
                                                "then": {"properties": {"radius": false}}})"));
}

TEST(JsonSchema, AConditionNamesOnlyWhatTheKeyDependsOn) {
  const json schema = written([](YamlMap& map) {
    map.word("a", {"x", "y"}, "") == "x" ? map.number("of_x", {}, "") : map.number("of_y", {}, "");
    if (map.has("b")) {
      map.number("b", {}, "");
      map.number("with_b", {}, "");
    }
  });
  for (const json& rule : schema["allOf"]) EXPECT_FALSE(rule["if"].contains("allOf")) << rule;
}

TEST(JsonSchema, MapsThatAreAlikeAreDefinedOnce) {
  const auto part = [](YamlMap& map) { map.number("mass", {0, 1}, ""); };
  const json schema = written([&](YamlMap& map) {
    map.section("left", "", part);
    map.section("right", "", part);
    map.list("others", 0, "", [&](YamlMap& item, std::size_t) { part(item); });
  });
  EXPECT_EQ(schema["definitions"].size(), 1u);
  EXPECT_EQ(schema["properties"]["others"]["items"], schema["properties"]["left"]["allOf"][0]);
}

TEST(JsonSchema, WhatNoKeyTellsAllowsEitherForm) {
  const json schema =
      written([](YamlMap& map) { map.number(map.either("turns", true) ? "deg" : "mm", {}, ""); });
  EXPECT_EQ(schema["anyOf"].size(), 2u);
}

}  // namespace
}  // namespace understudy::report
