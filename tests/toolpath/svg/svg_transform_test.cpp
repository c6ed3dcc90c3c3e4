#include "toolpath/svg/svg_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/frames.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    svg_transform(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr double kRounding = 1e-12;

// Where (3, 1) goes, by hand from SVG 1.1, 7.6.
TEST(SvgTransform, MovesPointsAsTheStandardSays) {
  const std::vector<std::pair<std::string, Vec2>> cases{{"", {3, 1}},
                                                        {"translate(2)", {5, 1}},
                                                        {"translate(2,-4)", {5, -3}},
                                                        {"scale(2)", {6, 2}},
                                                        {"scale(2 0.5)", {6, 0.5}},
                                                        {"rotate(90)", {-1, 3}},
                                                        {"rotate(90, 3, 0)", {2, 0}},
                                                        {"skewX(45)", {4, 1}},
                                                        {"skewY(45)", {3, 4}},
                                                        {"matrix(1 2 3 4 5 6)", {11, 16}},
                                                        {"translate(10,0) scale(2)", {16, 2}},
                                                        {" scale(-1,1) , translate( 1e1 0 ) ", {-13, 1}}};
  for (const auto& [text, expected] : cases)
    EXPECT_LT((svg_transform(text) * Vec2(3, 1) - expected).norm(), kRounding) << text;
}

TEST(SvgTransform, RefusesThoseThatLayADrawingOnALineOrAPoint) {
  for (const char* text : {"scale(0)", "scale(1,0)", "matrix(1 2 2 4 0 0)", "skewX(90)", "scale(1 1e-9)",
                           "rotate(30) scale(0 1)"})
    EXPECT_THAT(refusal(text), HasSubstr("no inverse")) << text;
}

TEST(SvgTransform, RefusesWhatIsNone) {
  EXPECT_THAT(refusal("turn(30)"), HasSubstr("'turn' is none of matrix"));
  EXPECT_THAT(refusal("rotate(1,2)"), HasSubstr("rotate has 2 numbers, it takes 1 or 3"));
  EXPECT_THAT(refusal("scale()"), HasSubstr("scale has 0 numbers"));
  EXPECT_THAT(refusal("scale(a)"), HasSubstr("'a' is not a number"));
  EXPECT_THAT(refusal("scale(nan)"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(refusal("scale 2"), HasSubstr("no function"));
}

}  // namespace
}  // namespace understudy::toolpath
