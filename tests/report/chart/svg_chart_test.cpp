#include "report/chart/svg_chart.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Scale, TicksAreRoundAndAboutFive) {
  EXPECT_THAT(Scale::linear(0, 100).ticks(), ElementsAre(0, 20, 40, 60, 80, 100));
  EXPECT_THAT(Scale::linear(-1.1, 1.1).ticks(), ElementsAre(-1, -0.5, 0, 0.5, 1));
  EXPECT_FALSE(std::signbit(Scale::linear(-1.1, 1.1).ticks()[2])) << "no -0";
  EXPECT_THAT(Scale::logarithmic(1, 30).ticks(), ElementsAre(1, 2, 5, 10, 20));
}

TEST(Scale, SharesGoFromEndToEnd) {
  EXPECT_EQ(Scale::linear(-2, 2).share(1), 0.75);
  EXPECT_NEAR(Scale::logarithmic(1, 100).share(10), 0.5, 1e-12);
  EXPECT_EQ(Scale::logarithmic(1, 100).share(0), 0) << "held at the end";
}

TEST(SvgChart, PutsValuesWhereTheScalesSay) {
  SvgChart chart({120, 110, 10, 10, 5, 5}, Scale::linear(0, 10), Scale::linear(0, 10));
  chart.dot({5, 10, 3}, "#000", "a < b");
  const std::string svg = chart.finish();
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"63.0\" cy=\"5.0\""));  // the middle, 3 px aside, at the top
  EXPECT_THAT(svg, HasSubstr("<title>a &lt; b</title>"));
}

TEST(SvgChart, ABandGoesThereAndBack) {
  SvgChart chart({100, 100, 0, 0, 0, 0}, Scale::linear(0, 1), Scale::linear(0, 1));
  chart.band({{0, 0}, {1, 0}}, {{0, 1}, {1, 1}}, "#000");
  EXPECT_THAT(chart.finish(), HasSubstr("points=\"0.0,100.0 100.0,100.0 100.0,0.0 0.0,0.0\""));
}

}  // namespace
}  // namespace understudy::report
