#include "toolpath/svg/svg_outlines.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

constexpr double kChord = 2e-6;     // [m], asked for
constexpr double kRounding = 1e-9;  // [m]

class SvgOutlines : public testing::Test {
 protected:
  /// `body` on a page of 100 x 50 mm, a unit a millimetre.
  std::vector<SvgStroke> page(const std::string& body) {
    return read("<svg width=\"100mm\" height=\"50mm\" viewBox=\"0 0 100 50\">\n" + body + "</svg>");
  }
  std::vector<SvgStroke> read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_svg(path_, kChord);
  }
  std::string refusal(const std::string& body) { return refusal_of("<svg>\n" + body + "</svg>"); }
  std::string refusal_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.string().size());
    }
    return "accepted";
  }
  static double length(const SvgStroke& stroke) {
    double sum = 0;
    for (std::size_t i = 1; i < stroke.points.size(); ++i)
      sum += (stroke.points[i] - stroke.points[i - 1]).norm();
    return sum;
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "page.svg";
};

TEST_F(SvgOutlines, PointsUpwardsInMillimetresOfThePage) {
  const auto strokes = page("<polyline points='10,20 30,20 30,5'/>");
  ASSERT_EQ(strokes.size(), 1u);
  ASSERT_EQ(strokes[0].points.size(), 3u);
  EXPECT_LT((strokes[0].points[0] - Vec2(10e-3, -20e-3)).norm(), kRounding);
  EXPECT_LT((strokes[0].points[2] - Vec2(30e-3, -5e-3)).norm(), kRounding);
}

// CSS: 96 px an inch; a page of 200 units over 100 mm has units of half a millimetre.
TEST_F(SvgOutlines, TakesSizesFromThePage) {
  const std::string line = "<line x1='0' y1='0' x2='96' y2='0'/></svg>";
  EXPECT_NEAR(length(read("<svg>" + line)[0]), 25.4e-3, kRounding);
  EXPECT_NEAR(length(read("<svg width='100mm' viewBox='0 0 200 200'>" + line)[0]), 48e-3, kRounding);
  EXPECT_NEAR(length(read("<svg width='1in' height='2in' viewBox='0 0 96 96'>" + line)[0]), 25.4e-3,
              kRounding);
}

TEST_F(SvgOutlines, ClosesWhatIsClosed) {
  const auto strokes = page(
      "<polygon points='0,0 3,0 3,4'/><rect x='1' y='1' width='4' height='2'/>"
      "<path d='M 0 0 h 5 v 5 z M 10 0 l 2 0'/>");
  ASSERT_EQ(strokes.size(), 4u);
  EXPECT_NEAR(length(strokes[0]), 12e-3, kRounding);
  EXPECT_NEAR(length(strokes[1]), 12e-3, kRounding);
  EXPECT_NEAR(length(strokes[2]), (10 + std::sqrt(50)) * 1e-3, kRounding);
  EXPECT_NEAR(length(strokes[3]), 2e-3, kRounding);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(strokes[i].points.front(), strokes[i].points.back()) << i;
}

// A chord that is c from an arc of radius r leaves less than 4 c / 3 r of its length out.
TEST_F(SvgOutlines, FollowsCurvesWithinTheChord) {
  const double circle = 2 * std::numbers::pi * 10e-3;
  for (const char* body : {"<circle cx='20' cy='20' r='10'/>", "<ellipse cx='20' cy='20' rx='10' ry='10'/>",
                           "<path d='M 10 20 A 10 10 0 0 1 30 20 A 10 10 0 0 1 10 20'/>",
                           "<g transform='scale(0.5)'><rect width='40' height='40' rx='20'/></g>"}) {
    const auto strokes = page(body);
    ASSERT_EQ(strokes.size(), 1u) << body;
    EXPECT_NEAR(length(strokes[0]), circle, 4e-4 * circle) << body;
  }
  // An S of a cubic: y = 27 t (1 - t) (1 - 2 t) over x = 10 t would need its inner control points at x = 10 /
  // 3 and 20 / 3, y = 9 and -9; its chord runs through the middle.
  const auto s = page("<path d='M 0 0 C 3.3333333 9 6.6666667 -9 10 0'/>");
  for (const Vec2& p : s.at(0).points) {
    const double t = p.x() / 10e-3;
    EXPECT_NEAR(p.y(), -27e-3 * t * (1 - t) * (1 - 2 * t), 1e-8) << t;
  }
  EXPECT_GT(s[0].points.size(), 20u);
}

TEST_F(SvgOutlines, AppliesTheTransformsOfGroupsFromTheInnermostOutwards) {
  const auto strokes = page(
      "<g transform='translate(10,0)'><g transform='rotate(90)'>"
      "<line transform='scale(2)' x1='0' y1='0' x2='3' y2='0'/></g></g>");
  EXPECT_LT((strokes.at(0).points.at(0) - Vec2(10e-3, 0)).norm(), kRounding);
  EXPECT_LT((strokes.at(0).points.at(1) - Vec2(10e-3, -6e-3)).norm(), kRounding);
}

TEST_F(SvgOutlines, LeavesOutWhatIsNotShown) {
  EXPECT_EQ(page("<defs><circle r='1'/></defs><title>t</title><inkscape:grid/><line display='none' x2='9'/>"
                 "<line x2='5'/>")
                .size(),
            1u);
}

TEST_F(SvgOutlines, RefusesTransformsThatDegenerateWithElementLineAndValue) {
  EXPECT_THAT(refusal("<path id=\"u\" transform=\"scale(1,0)\" d=\"M 0 0 h 5\"/>"),
              HasSubstr(":2: <path id=\"u\">: transform=\"scale(1,0)\": it has no inverse"));
  EXPECT_THAT(refusal("<g id='all' transform='matrix(1 2 2 4 0 0)'>\n<line x2='5'/></g>"),
              HasSubstr(":2: <g id=\"all\">: transform=\"matrix(1 2 2 4 0 0)\""));
  EXPECT_THAT(refusal_of("<svg viewBox='0 0 0 50'><line x2='5'/></svg>"), HasSubstr("viewBox=\"0 0 0 50\""));
}

TEST_F(SvgOutlines, RefusesWhatHasNoOutlineOrIsNone) {
  EXPECT_THAT(refusal("<text>U</text>"), HasSubstr("<text>: it has no outline"));
  EXPECT_THAT(refusal("<use href='#u'/>"), HasSubstr("<use>: it has no outline"));
  EXPECT_THAT(refusal("<path d='M 0 0 L 5'/>"), HasSubstr("is no path data"));
  EXPECT_THAT(refusal("<path/>"), HasSubstr("it has no d"));
  EXPECT_THAT(refusal("<circle r='-1'/>"), HasSubstr("must be above 0"));
  EXPECT_THAT(refusal("<circle r='5em'/>"), HasSubstr("r=\"5em\" is not a number"));
  EXPECT_THAT(refusal("<polyline points='1 2 3'/>"), HasSubstr("3 numbers"));
  EXPECT_THAT(refusal("<circle r='1e300'/>"), HasSubstr("from the drawing's origin, at most 100 m are read"));
  EXPECT_THAT(refusal("<line x2='5e5'/>"), HasSubstr("132 m from the drawing's origin"));
  EXPECT_THAT(refusal(""), HasSubstr("no outline: nothing to print"));
  EXPECT_THAT(refusal_of("<html/>"), HasSubstr("no <svg>"));
  EXPECT_THAT(refusal_of("G1 X5"), HasSubstr("no XML"));
  EXPECT_THAT(refusal_of("<svg width='-5mm'><line x2='5'/></svg>"), HasSubstr("width=\"-5mm\" is no length"));
}

}  // namespace
}  // namespace understudy::toolpath
