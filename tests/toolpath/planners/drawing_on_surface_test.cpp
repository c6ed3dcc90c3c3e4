#include "toolpath/planners/drawing_on_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

const std::string kParts = UNDERSTUDY_SOURCE_DIR "/models/parts/";
// An L, 10 wide and 20 high: from its upper left corner down, and to the right.
const std::vector<std::vector<Vec2>> kDrawing{{{0, 20e-3}, {0, 0}, {10e-3, 0}}};
constexpr double kSlant = 15 * kDegree;
constexpr double kRounding = 1e-7;  // [m], single precision of an STL

std::string refusal(const geometry::Mesh& mesh, const DrawingPlace& place) {
  try {
    drawing_on_surface(mesh, kDrawing, place);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// The box falls towards +x: uphill is -x, and the drawing's x runs along +y.
TEST(DrawingOnSurface, KeepsLengthsOnASlantedPlaneItsUpperSideUphill) {
  const auto box = geometry::read_stl(kParts + "slanted_box.stl");
  const auto curves = drawing_on_surface(*box, kDrawing, {Vec3(0, 0, 18e-3)});
  ASSERT_EQ(curves.size(), 1u);
  const auto at = [&](double across, double up) {
    return Vec3(-up * std::cos(kSlant), across, 18e-3 + up * std::sin(kSlant));
  };
  EXPECT_LT((curves[0].front() - at(-5e-3, 10e-3)).norm(), kRounding);
  EXPECT_LT((curves[0].back() - at(5e-3, -10e-3)).norm(), kRounding);
}

TEST(DrawingOnSurface, TurnsAboutTheNormalAndStretchesToItsWidth) {
  const auto box = geometry::read_stl(kParts + "slanted_box.stl");
  DrawingPlace place{Vec3(0, 0, 18e-3)};
  place.turn = 90 * kDegree;
  place.width = 5e-3;  // half of what it has
  const auto curves = drawing_on_surface(*box, kDrawing, place);
  // Its x runs uphill then, its y along -y.
  const Vec3 from(2.5e-3 * std::cos(kSlant), -5e-3, 18e-3 - 2.5e-3 * std::sin(kSlant));
  EXPECT_LT((curves[0].front() - from).norm(), kRounding);
}

// A cylinder of 15.5 mm radius along y, its top at 31 mm: the part of the drawing that is x beside the top
// lies r - sqrt(r^2 - x^2) below it. Facets of 1 degree: 0.6 um.
TEST(DrawingOnSurface, FollowsAMesh) {
  const auto bottle = geometry::read_stl(kParts + "bottle.stl");
  const auto curves = drawing_on_surface(*bottle, kDrawing, {Vec3(0, 0, 31e-3)});
  for (const Vec3& p : curves[0])
    EXPECT_NEAR(std::hypot(p.x(), p.z() - 15.5e-3), 15.5e-3, 1e-6) << p.transpose();
  EXPECT_GE(curves[0].size(), 31u);  // steps of a millimetre at most
  EXPECT_NEAR(curves[0].front().x(), -5e-3, kRounding);
  EXPECT_NEAR(curves[0].front().y(), 10e-3, kRounding);
}

TEST(DrawingOnSurface, RefusesPlacesOffThePart) {
  const auto box = geometry::read_stl(kParts + "slanted_box.stl");
  EXPECT_THAT(refusal(*box, {Vec3(0, 0, 30e-3)}), HasSubstr("mm from the part, more than 5 mm"));
  EXPECT_THAT(refusal(*box, {Vec3(0, 18e-3, 18e-3)}), HasSubstr("reaches beyond the part"));
  DrawingPlace wide{Vec3(0, 0, 18e-3)};
  wide.width = 10e-3;
  EXPECT_THROW(drawing_on_surface(*box, {{{0, 0}, {0, 5e-3}}}, wide), InputError);
}

}  // namespace
}  // namespace understudy::toolpath
