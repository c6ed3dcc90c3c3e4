// The built machine and part as the twin takes them.
#include "sim/as_built/truth.h"

#include <gtest/gtest.h>

#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

std::shared_ptr<const geometry::Mesh> box() {
  auto t = geometry::box({-5e-3, -10e-3, 0}, {5e-3, 10e-3, 30e-3});
  return std::make_shared<const geometry::Mesh>(std::move(t.vertices), std::move(t.triangles));
}

TEST(TrueDescription, TakesWhatIsBuiltAndLeavesTheControllersAlone) {
  const machine::MachineDescription described = machine::load_machine("hexapod");
  const Pose laser = described.laser.X_TL;
  AsBuilt built = as_described(described);
  built.laser.X_TL.translation().x() += 1e-3;
  built.microscope.blur_px = 2;
  built.filament_diameter = 1.7e-3;
  built.extruder_lag = 0.1;
  const machine::MachineDescription truth = true_description(described, built);
  EXPECT_EQ(truth.laser.X_TL.matrix(), built.laser.X_TL.matrix());
  EXPECT_EQ(truth.microscope.blur_px, 2);
  EXPECT_EQ(truth.tool.filament_diameter, 1.7e-3);
  EXPECT_EQ(truth.process.extruder_lag, 0.1);
  EXPECT_EQ(described.laser.X_TL.matrix(), laser.matrix());
  EXPECT_NE(described.tool.filament_diameter, 1.7e-3);
}

TEST(TruePart, IsTheDrawnOneWhereNothingDiffers) {
  const auto drawn = box();
  EXPECT_EQ(true_part(drawn, {}), drawn);
  EXPECT_EQ(true_part(nullptr, {Pose::Identity(), 2, 0, 0}), nullptr);
}

TEST(TruePart, StandsGrownAndMovedWhereItIsClamped) {
  const auto drawn = box();
  BuiltPart part;
  part.size = 1.01;
  part.X_WF.translation() = Vec3(1e-3, -2e-3, 0);
  const auto built = true_part(drawn, part);
  EXPECT_TRUE(built->upper().isApprox(1.01 * drawn->upper() + part.X_WF.translation(), 1e-12));
  EXPECT_TRUE(built->lower().isApprox(1.01 * drawn->lower() + part.X_WF.translation(), 1e-12));
  EXPECT_NEAR(built->volume(), std::pow(1.01, 3) * drawn->volume(), 1e-15);
}

TEST(TruePart, RippleMovesTheSurfaceAlongItsNormalByItsAmplitudeAtMost) {
  const auto drawn = box();
  const double ripple = 10e-6;
  const auto built = true_part(drawn, {Pose::Identity(), 1, ripple, 0.3});
  double most = 0;
  for (std::size_t i = 0; i < drawn->vertices().size(); ++i) {
    const Vec3 by = built->vertices()[i] - drawn->vertices()[i];
    most = std::max(most, by.norm());
    EXPECT_NEAR(by.cross(drawn->vertex_normals()[i]).norm(), 0, 1e-12) << "vertex " << i;
  }
  EXPECT_LE(most, ripple * (1 + 1e-9));
  EXPECT_GT(most, ripple / 2) << "of eight corners on different phases one is near a crest";
}

}  // namespace
}  // namespace understudy::sim
