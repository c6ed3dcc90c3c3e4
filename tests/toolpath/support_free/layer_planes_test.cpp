#include "toolpath/support_free/layer_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "models/parts/swept_part.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

StructuralLine axis_of(const std::vector<SweptPiece>& pieces) {
  std::vector<Vec3> points;
  const int count = static_cast<int>(swept_length(pieces) / 0.5e-3);
  for (int i = 0; i <= count; ++i)
    points.push_back(swept_pose(pieces, swept_length(pieces) * i / count).translation());
  return StructuralLine(points);
}

const LayerRange kRange{0.2e-3, 0.08e-3, 0.32e-3, 20 * kDegree};

std::string refusal(const std::vector<SweptPiece>& pieces, const LayerRange& range) {
  try {
    curved_layers(*swept_part(circle_mm(6), pieces), axis_of(pieces), range);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// About the centre of a bend of radius R layers are wedges: h (1 +- r / R) high.
TEST(CurvedLayers, AreWedgesInABend) {
  const auto pieces = one_bend();
  const auto layers = curved_layers(*swept_part(circle_mm(6), pieces), axis_of(pieces), kRange);
  ASSERT_EQ(layers.size(), static_cast<std::size_t>(std::lround(swept_length(pieces) / 0.2e-3)));
  for (const CurvedLayer& layer : layers) {
    EXPECT_LT(layer.lag, 1e-6);
    if (layer.at < 12e-3 || layer.at > 40e-3) continue;
    // The bend leads towards x: there is its inside.
    const Vec2 inside = layer.middle.in(layer.middle.origin + 6e-3 * layer.middle.u);
    EXPECT_NEAR(layer.over(inside).thickness, 0.2e-3 * (1 - 6.0 / 30), 3e-6) << layer.at;
    EXPECT_NEAR(layer.over(-inside).thickness, 0.2e-3 * (1 + 6.0 / 30), 3e-6) << layer.at;
    EXPECT_NEAR(layer.over({0, 0}).thickness, 0.2e-3, 2e-6) << layer.at;
  }
  EXPECT_NEAR(to_deg(turn_between(layers.back().top.normal(), Vec3::UnitZ())), 60, 0.2);
}

TEST(CurvedLayers, LieOneOnTheOther) {
  const auto pieces = bends_in_two_planes();
  const auto layers = curved_layers(*swept_part(circle_mm(6), pieces), axis_of(pieces), kRange);
  for (std::size_t k = 1; k < layers.size(); ++k) {
    EXPECT_EQ(layers[k].bottom.origin, layers[k - 1].top.origin);
    EXPECT_EQ(layers[k].bottom.normal(), layers[k - 1].top.normal());
  }
  EXPECT_EQ(layers.front().bottom.normal(), Vec3::UnitZ());
  EXPECT_NEAR(layers.front().bottom.origin.z(), 0, 1e-12);
}

/// r / R = 6 / 8.5: with 0.2 mm the outside would be 0.341 mm high; 0.17 mm and the middle of the range fit.
TEST(CurvedLayers, AreThinnerWhereTheLineBendsSharply) {
  const std::vector<SweptPiece> pieces{straight_mm(5), arc_mm(11, 60), straight_mm(5)};
  LayerRange range = kRange;
  range.thickest = 0.3e-3;
  const auto layers = curved_layers(*swept_part(circle_mm(6), pieces), axis_of(pieces), range);
  EXPECT_GT(layers.size(), swept_length(pieces) / 0.2e-3 + 1);
  for (const CurvedLayer& layer : layers)
    for (const Vec2& p : layer.section.contours.front()) {
      EXPECT_GT(layer.over(p).thickness, range.thinnest);
      EXPECT_LT(layer.over(p).thickness, range.thickest);
    }
}

TEST(CurvedLayers, RefuseABendThatNoLayerCanFollow) {
  const std::string why = refusal({straight_mm(5), arc_mm(7, 80), straight_mm(5)}, kRange);
  EXPECT_THAT(why, HasSubstr("the line bends too sharply for layers of 0.08 to 0.32 mm over a section of"));
  EXPECT_THAT(why, HasSubstr("more than 20.0 deg"));
  LayerRange range = kRange;
  range.thickest = 0.1e-3;
  EXPECT_THAT(refusal(one_bend(), range), HasSubstr("a layer of 0.2 mm is outside of 0.08 to 0.1 mm"));
}

TEST(CurvedLayers, RefuseALineThatLeavesThePart) {
  const auto part = swept_part(circle_mm(6), one_bend());
  const StructuralLine straight({Vec3(0, 0, 0), Vec3(0, 0, 0.05)});
  EXPECT_THROW(curved_layers(*part, straight, kRange), InputError);
  const StructuralLine beside({Vec3(0.1, 0, 0), Vec3(0.1, 0, 0.05)});
  EXPECT_THROW(curved_layers(*part, beside, kRange), InputError);
}

}  // namespace
}  // namespace understudy::toolpath
