#include "toolpath/inspection/told_beads.h"

#include <numbers>

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

constexpr double kRounding = 1e-15;  // [m]: decimal text to doubles

TEST(ToldBeads, PrusaSlicersCommentsHoldUntilTheNext) {
  const ToldBeads beads(
      "G28\n;LAYER_CHANGE\n;Z:0.35\n;HEIGHT:0.35\n;TYPE:Perimeter\n;WIDTH:0.7\nG1 X1\n"
      ";HEIGHT:0.1\r\n;WIDTH:0.449999\nG1 X2\n");
  EXPECT_EQ(beads.at(1).height, 0);
  EXPECT_EQ(beads.at(5).width, 0) << "not told yet";
  EXPECT_EQ(beads.at(5).area(), 0);
  EXPECT_NEAR(beads.at(7).height, 0.35e-3, kRounding);
  EXPECT_NEAR(beads.at(7).width, 0.7e-3, kRounding);
  EXPECT_NEAR(beads.at(10).height, 0.1e-3, kRounding);
  EXPECT_NEAR(beads.at(1000).width, 0.449999e-3, kRounding);
  EXPECT_NEAR(beads.at(7).area(), 0.35e-6 * 0.35 + std::numbers::pi / 4 * 0.35e-3 * 0.35e-3, 1e-18);
}

TEST(ToldBeads, BambuStudioCallsThemByOtherNames) {
  const ToldBeads beads("; CHANGE_LAYER\n; Z_HEIGHT: 0.4\n; LAYER_HEIGHT: 0.2\n; LINE_WIDTH: 0.42\nG1 X1\n");
  EXPECT_NEAR(beads.at(5).height, 0.2e-3, kRounding);
  EXPECT_NEAR(beads.at(5).width, 0.42e-3, kRounding);
}

TEST(ToldBeads, BridgesOverhangsAndIroningLieOnNoLayer) {
  for (const char* type : {";TYPE:Bridge infill", ";TYPE:Overhang perimeter", "; FEATURE: Overhang wall",
                           "; FEATURE: Ironing"}) {
    const ToldBeads beads(std::string(";HEIGHT:0.2\n;WIDTH:0.45\n") + type +
                          "\n;HEIGHT:0.4\nG1 X1\n;TYPE:Perimeter\n;HEIGHT:0.2\nG1 X2\n");
    EXPECT_EQ(beads.at(5).height, 0) << type;
    EXPECT_NEAR(beads.at(8).height, 0.2e-3, kRounding) << type;
    EXPECT_FALSE(beads.supports());
  }
}

TEST(ToldBeads, OtherCommentsAndLengthsThatNoBeadHasTellNothing) {
  for (const char* comment : {"; layer height = 0.2", ";HEIGHT:", ";HEIGHT:-1", ";HEIGHT:nan", ";HEIGHT:1e9",
                              "G1 X1 ;HEIGHT:0.2", ";SKIRT_HEIGHT:3"})
    EXPECT_TRUE(ToldBeads(comment).empty()) << comment;
  EXPECT_EQ(ToldBeads(";HEIGHT:0.4\n;WIDTH:0.2\n").at(3).area(), 0) << "higher than wide";
}

TEST(ToldBeads, SupportsAreKnownByTheirType) {
  EXPECT_TRUE(ToldBeads(";TYPE:Support material interface\n").supports());
  EXPECT_FALSE(ToldBeads(";TYPE:Perimeter\n; support_material = 0\n").supports());
}

}  // namespace
}  // namespace understudy::toolpath
