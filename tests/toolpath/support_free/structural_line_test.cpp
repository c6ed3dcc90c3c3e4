#include "toolpath/support_free/structural_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/toolpath/support_free/bent_parts_for_test.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

std::string refusal(const geometry::Mesh& part, double step = 1e-3) {
  try {
    find_structural_line(part, step, 20e-6);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The farthest that the line is off the axis along which the part was swept.
double farthest_off(const StructuralLine& line, const std::vector<SweptPiece>& pieces) {
  double farthest = 0;
  for (int i = 0; i <= 200; ++i) {
    const Vec3 p = line.at(line.length() * i / 200);
    double nearest = 1;
    for (int k = 0; k <= 4000; ++k)
      nearest =
          std::min(nearest, (swept_pose(pieces, swept_length(pieces) * k / 4000).translation() - p).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

class FoundLine : public testing::TestWithParam<Bent> {};

/// A section across the axis of a swept part has its middle on the axis; a step of the test's own axis is 15
/// um.
TEST_P(FoundLine, IsTheAxisAlongWhichThePartWasSwept) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  const StructuralLine line = find_structural_line(*part, 1e-3, 20e-6);
  EXPECT_LT(farthest_off(line, pieces), 60e-6);
  EXPECT_NEAR(line.length(), swept_length(pieces), 0.1e-3);
  EXPECT_NEAR(line.at(0).norm(), 0, 20e-6);
  EXPECT_LT((line.at(line.length()) - swept_pose(pieces, swept_length(pieces)).translation()).norm(), 60e-6);
  for (const double share : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    const Vec3 axis = swept_pose(pieces, share * swept_length(pieces)).linear().col(2);
    EXPECT_LT(turn_between(line.tangent(share * line.length()), axis), 1.5 * kDegree) << share;
  }
}

INSTANTIATE_TEST_SUITE_P(StructuralLine, FoundLine, testing::ValuesIn(bent_parts()), name_of_part);

TEST(StructuralLine, OfAStraightPartIsItsAxis) {
  const std::vector<SweptPiece> pieces{straight_mm(20)};
  EXPECT_LT(farthest_off(find_structural_line(*swept_part(circle_mm(6), pieces), 1e-3, 20e-6), pieces),
            60e-6);
}

/// A first walk in long steps cuts corners; sections across the line as it is by then put that right.
TEST(StructuralLine, IsTheAxisEvenWhereTheStepsAreLong) {
  const std::vector<SweptPiece> pieces{straight_mm(4), arc_mm(12, 80), straight_mm(6)};
  const auto part = swept_part(circle_mm(4), pieces);
  EXPECT_LT(farthest_off(find_structural_line(*part, 2e-3, 20e-6), pieces), 60e-6);
}

TEST(StructuralLine, RunsThroughItsPointsAndAlongAnArc) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 30; ++i) {
    const double a = i * 3 * kDegree;
    points.emplace_back(0.03 * (1 - std::cos(a)), 0, 0.03 * std::sin(a));
  }
  const StructuralLine line(points);
  for (int i = 0; i <= 100; ++i) {
    const double s = line.length() * i / 100;
    const Vec3 p = line.at(s);
    EXPECT_NEAR((p - Vec3(0.03, 0, 0)).norm(), 0.03, 2e-6) << i;
    const double a = std::atan2(p.z(), 0.03 - p.x());
    EXPECT_LT(turn_between(line.tangent(s), Vec3(std::sin(a), 0, std::cos(a))), 0.1 * kDegree) << i;
  }
}

TEST(StructuralLine, RefusesPointsThatMakeNone) {
  EXPECT_THROW(StructuralLine({Vec3(0, 0, 0)}), InputError);
  EXPECT_THROW(StructuralLine({Vec3(0, 0, 0), Vec3(0, 0, 0)}), InputError);
}

/// 10 mm thick; the column, 20 mm high, stands under one end of a bar of 60 mm.
geometry::Mesh column_under_a_bar() {
  const std::vector<Vec2> outline{Vec2(-0.005, -0.02), Vec2(0.005, -0.02), Vec2(0.005, -0.005),
                                  Vec2(0.055, -0.005), Vec2(0.055, 0.005), Vec2(-0.005, 0.005)};
  const int n = static_cast<int>(outline.size());
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (const double y : {-0.005, 0.005}) {
    for (const Vec2& p : outline) vertices.emplace_back(p.x(), y, p.y());
    vertices.emplace_back(0, y, 0);  // from which all of the outline is seen
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n, back = n + 1;
    triangles.push_back({n, i, j});
    triangles.push_back({back + n, back + j, back + i});
    triangles.push_back({i, back + i, back + j});
    triangles.push_back({i, back + j, j});
  }
  return {vertices, triangles};
}

TEST(StructuralLine, RefusesPartsThatHaveNone) {
  const auto tube = swept_part(circle_mm(6), one_bend());
  EXPECT_THAT(refusal(*tube, 0), HasSubstr("step of the structural line"));
  EXPECT_THAT(refusal(*swept_part(circle_mm(6), {straight_mm(1.5)}), 1e-3),
              HasSubstr("shorter than three steps"));
  EXPECT_THAT(refusal(column_under_a_bar()), HasSubstr("the part forks at"));
  auto triangles = tube->triangles();
  triangles.pop_back();
  EXPECT_THAT(refusal(geometry::Mesh(tube->vertices(), triangles)), HasSubstr("open edges"));
}

}  // namespace
}  // namespace understudy::toolpath
