#include "core/yaml/yaml_quoted.h"

#include <gtest/gtest.h>

#include "core/yaml/yaml_map.h"

namespace understudy {
namespace {

TEST(YamlQuoted, ReadsBackAsTheSameText) {
  for (const std::string text : {"plain", "a \"word\": 3 # no comment", "back\\slash\\n",
                                 "two\nlines\tand a tab\r", "{not: a map}", "µm"}) {
    std::string read;
    YamlMap::read_text("text: " + yaml_quoted(text) + "\n", "file",
                       [&](YamlMap& map) { read = map.text("text", "any"); });
    EXPECT_EQ(read, text);
  }
}

}  // namespace
}  // namespace understudy
