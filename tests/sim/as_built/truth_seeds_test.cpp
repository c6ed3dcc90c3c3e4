// A group's seed changes what belongs to the group, and nothing else.
#include "sim/as_built/truth_seeds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/as_built/as_built.h"
#include "sim/as_built/as_built_file.h"
#include "tests/shipped_hexapod.h"

namespace understudy::sim {
namespace {

std::string text(AsBuilt built) {
  built.seed = 0;
  return write_as_built(built);
}

/// Some numbers of each group, by its order.
std::vector<std::vector<double>> truths(const AsBuilt& b) {
  const auto& camera = b.microscope.camera;
  return {{b.hexapod.base_joint[3].x(), b.hexapod.length_offset[5]},
          {b.drives[1].scale},
          {b.drives[1].periodic, b.drives[4].phase},
          {b.nut_play[2], b.ball_play[0]},
          {b.laser.X_TL.translation().x(), camera.focal_px},
          {camera.centre_px.x(), camera.k1, b.microscope.blur_px},
          {b.laser.peak_level, b.laser.waist_diameter, b.microscope.ambient_level},
          {b.part.X_WF.translation().y(), b.part.X_WF.linear()(0, 1)},
          {b.part.size, b.part.ripple, b.part.phase},
          {b.table.height, b.table.slope.y(), b.table.bow},
          {b.filament_diameter, b.extruder_lag, b.nozzle_offset}};
}

TEST(TruthSeeds, AGroupIsThatOfItsSeedAndTheOthersStay) {
  const auto of = [](const TruthSeeds& seeds) {
    return truths(make_as_built(hexapod(), "manufactured", seeds));
  };
  const auto a = of(21), b = of(22);
  for (std::size_t g = 0; g < a.size(); ++g) {
    TruthSeeds seeds(21);
    seeds[static_cast<TruthGroup>(g)] = 22;
    const auto mixed = of(seeds);
    for (std::size_t other = 0; other < a.size(); ++other)
      EXPECT_EQ(mixed[other], other == g ? b[other] : a[other]) << to_string(static_cast<TruthGroup>(g));
    for (std::size_t k = 0; k < a[g].size(); ++k) EXPECT_NE(a[g][k], b[g][k]);
  }
}

TEST(TruthSeeds, AllGroupsFromOneSeedAreTheWorldOfThatSeed) {
  TruthSeeds seeds(5);
  for (const TruthGroup group : all_truth_groups()) seeds[group] = 6;
  EXPECT_EQ(text(make_as_built(hexapod(), "manufactured", seeds)),
            text(make_as_built(hexapod(), "manufactured", 6)));
}

TEST(DrawnTruths, AreThoseThatTheSetSpreads) {
  using testing::ElementsAre;
  EXPECT_THAT(drawn_truths(hexapod(), "nominal"), testing::IsEmpty());
  EXPECT_THAT(drawn_truths(hexapod(), "sampled"), ElementsAre(TruthGroup::geometry));
  EXPECT_EQ(drawn_truths(hexapod(), "manufactured").size(), kTruthGroups - 1);  // noise is not built
  // Its file states tolerances of the geometry alone.
  EXPECT_THAT(drawn_truths(machine::load_machine("arm"), "manufactured"), ElementsAre(TruthGroup::geometry));
}

}  // namespace
}  // namespace understudy::sim
