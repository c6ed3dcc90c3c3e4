#include "report/json_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::report {
namespace {

using Figures = std::map<std::string, std::variant<double, std::string>>;

TEST(JsonFigures, GoByTheirPathAndListsByTheirItemsNames) {
  const Figures expected{{"a.b", 1.5},
                         {"c", std::string("word")},
                         {"list.0", 1.0},
                         {"list.1", 2.0},
                         {"runs.one.name", std::string("one")},
                         {"runs.one.x", 3.0},
                         {"runs.two.name", std::string("two")},
                         {"yes", std::string("true")}};
  EXPECT_EQ(json_figures(R"({"a": {"b": 1.5}, "c": "word", "list": [1, 2], "none": null, "yes": true,
                            "runs": [{"name": "one", "x": 3}, {"name": "two"}]})",
                         "f"),
            expected);
}

TEST(JsonFigures, ItemsOfOneNameCount) {
  const Figures figures = json_figures(R"([{"n": "a", "x": 1}, {"n": "a", "x": 2}])", "f");
  EXPECT_EQ(figures.at("0.x"), (std::variant<double, std::string>(1.0)));
  EXPECT_EQ(figures.at("1.x"), (std::variant<double, std::string>(2.0)));
}

TEST(JsonFigures, WhatIsNoJsonIsRefused) {
  for (const std::string& text : {std::string("{"), std::string(), std::string(100000, '[')})
    EXPECT_THROW(json_figures(text, "f"), InputError);
}

}  // namespace
}  // namespace understudy::report
