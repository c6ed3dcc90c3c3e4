// What YamlMap::schema() finds out about readers.
#include "core/yaml/schema_recording.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/yaml/yaml_map.h"

namespace understudy {
namespace {

using testing::ElementsAre;

const KeySchema& key_of(const MapVariant& variant, const std::string& key) {
  for (const KeySchema& schema : variant.keys)
    if (schema.key == key) return schema;
  throw std::logic_error("no key " + key);
}

std::vector<std::string> keys_of(const MapVariant& variant) {
  std::vector<std::string> keys;
  for (const KeySchema& schema : variant.keys)
    if (schema.type != KeySchema::Type::none) keys.push_back(schema.key + (schema.required ? "" : "?"));
  return keys;
}

TEST(SchemaRecording, TellsTypeRangeUnitAndPhraseOfEachKey) {
  const MapSchema schema = YamlMap::schema([](YamlMap& map) {
    map.quantity("lead_mm", {0.1, 100}, "travel of one turn");
    if (map.has("name")) map.text("name", "shown");
  });
  ASSERT_EQ(schema.variants.size(), 1u);
  EXPECT_THAT(keys_of(schema.variants[0]), ElementsAre("lead_mm", "name?"));
  const KeySchema& lead = key_of(schema.variants[0], "lead_mm");
  EXPECT_EQ(lead.type, KeySchema::Type::number);
  EXPECT_EQ(lead.unit, "mm");
  EXPECT_EQ(lead.bounds, (Bounds{0.1, 100}));
  EXPECT_EQ(lead.about, "travel of one turn");
}

TEST(SchemaRecording, FindsTheKeysThatHideBehindAWord) {
  const MapSchema schema = YamlMap::schema([](YamlMap& map) {
    if (map.word("shape", {"ball", "box", "cube"}, "") == "ball")
      map.quantity("radius_mm", {}, "");
    else
      map.quantity("side_mm", {}, "");
  });
  ASSERT_EQ(schema.variants.size(), 3u);
  EXPECT_THAT(schema.variants[0].when, ElementsAre(Condition{"shape", "ball"}));
  EXPECT_THAT(keys_of(schema.variants[0]), ElementsAre("shape", "radius_mm"));
  EXPECT_THAT(keys_of(schema.variants[2]), ElementsAre("shape", "side_mm"));
}

TEST(SchemaRecording, FindsTheKeysThatHideBehindTheAbsenceOfOne) {
  const MapSchema schema = YamlMap::schema([](YamlMap& map) {
    if (!map.has("endless")) map.numbers("range", 2, {}, "");
    if (map.has("endless")) map.text("endless", "");
    if (map.has("jump")) map.number("jump", {}, "");  // by itself: no variant of its own
  });
  ASSERT_EQ(schema.variants.size(), 2u);
  EXPECT_THAT(keys_of(schema.variants[0]), ElementsAre("endless?", "jump?"));
  EXPECT_THAT(schema.variants[1].when, ElementsAre(Condition{"endless", kAbsent}));
  EXPECT_THAT(keys_of(schema.variants[1]), ElementsAre("range", "jump?"));
}

TEST(SchemaRecording, ListsOfAKnownLengthHaveAMapForEachEntryUnlessAllAreAlike) {
  const auto list = [](bool alike) {
    return YamlMap::schema([alike](YamlMap& map) {
             map.list("axes", 2, "", [alike](YamlMap& axis, std::size_t i) {
               axis.number(alike || i == 0 ? "slide" : "turn", {}, "");
             });
           })
        .variants[0]
        .keys[0];
  };
  EXPECT_EQ(list(true).maps.size(), 1u);
  EXPECT_EQ(list(false).maps.size(), 2u);
  EXPECT_EQ(list(true).count, 2u);
}

TEST(SchemaRecording, WhatNoKeyTellsGivesVariantsOfTheirOwn) {
  const MapSchema schema = YamlMap::schema([](YamlMap& map) {
    map.number(map.either("the axis turns", true) ? "play_arcmin" : "play_um", {}, "");
  });
  ASSERT_EQ(schema.variants.size(), 2u);
  EXPECT_EQ(schema.variants[0].when[0].key, "#the axis turns");
}

TEST(SchemaRecording, AReaderThatAsksDifferentlyUnderTheSameAnswersIsOurMistake) {
  int run = 0;
  EXPECT_THROW(YamlMap::schema([&run](YamlMap& map) { map.has("key" + std::to_string(run++)); }),
               std::logic_error);
}

}  // namespace
}  // namespace understudy
