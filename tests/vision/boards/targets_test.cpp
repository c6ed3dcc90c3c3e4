// Drawn targets; those that a renderer makes are in rendered_boards_test.cpp.
#include "vision/boards/targets.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/vision/boards/drawn_picture.h"

namespace understudy::vision {
namespace {

const std::array<Vec2, 3> kCentres = {Vec2(90.3, 90.6), Vec2(300.2, 80.9), Vec2(200.7, 220.4)};
constexpr double kRadius = 30;

TargetOptions options() {
  TargetOptions o;
  o.camera = {400, 300, 4267, Vec2(200, 150)};
  o.radius_px = kRadius;
  o.search_px = 60;
  return o;
}

Image targets_picture(std::vector<Disc> more = {}) {
  for (const Vec2& c : kCentres) more.push_back({c, kRadius});
  return drawn_discs(400, 300, more);
}

std::array<Vec2, 3> expected(const Vec2& off) {
  return {kCentres[0] + off, kCentres[1] + off, kCentres[2] + off};
}

TEST(Targets, EachIsFoundNearWhereItIsExpected) {
  const TargetsMeasurement m = measure_targets(targets_picture(), expected(Vec2(20, -25)), options());
  ASSERT_EQ(m.status, TargetStatus::ok) << to_string(m.status);
  EXPECT_EQ(m.failed_target, -1);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LE((m.targets[k].outline_px - kCentres[k]).norm(), 0.05);
    EXPECT_EQ(m.targets[k].contrast, kPaper - kInk);
  }
}

TEST(Targets, TheFirstThatIsMissingIsNamed) {
  std::array<Vec2, 3> elsewhere = expected(Vec2::Zero());
  elsewhere[1] = Vec2(350, 250);
  const TargetsMeasurement m = measure_targets(targets_picture(), elsewhere, options());
  EXPECT_EQ(m.status, TargetStatus::missing);
  EXPECT_EQ(m.failed_target, 1);
  EXPECT_EQ(m.targets[0].status, TargetStatus::ok);
}

TEST(Targets, TwoBlobsForOneTargetOrOneForTwoAreAmbiguous) {
  EXPECT_EQ(measure_targets(targets_picture({{Vec2(90, 20 + 135), 25}}), expected(Vec2(0, 10)),
                            [] {
                              TargetOptions o = options();
                              o.search_px = 70;
                              return o;
                            }())
                .status,
            TargetStatus::ambiguous);
  std::array<Vec2, 3> together = expected(Vec2::Zero());
  together[1] = kCentres[0] + Vec2(5, 5);
  EXPECT_EQ(measure_targets(targets_picture(), together, options()).status, TargetStatus::ambiguous);
}

TEST(Targets, APictureWithoutLightOrContrastSaysSo) {
  const auto plain = [](double level) {
    return drawn_picture(100, 100, [=](double, double) { return level; });
  };
  EXPECT_EQ(measure_targets(plain(100), kCentres, options()).status, TargetStatus::low_contrast);
  EXPECT_EQ(measure_targets(plain(255), kCentres, options()).status, TargetStatus::overexposed);
}

TEST(Targets, MomentsFindADiscsCentreToo) {
  EXPECT_LE((moment_centre(targets_picture(), kCentres[2] + Vec2(10, 5), kRadius) - kCentres[2]).norm(), 0.1);
}

TEST(Targets, OptionsThatCannotBeAreRefused) {
  TargetOptions o = options();
  o.camera.focal_px = 0;
  EXPECT_THROW(measure_targets(targets_picture(), kCentres, o), InputError);
  o = options();
  o.radius_px = 2;
  EXPECT_THROW(measure_targets(targets_picture(), kCentres, o), InputError);
}

}  // namespace
}  // namespace understudy::vision
