#include "machine/draft/table_place.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/description.h"

namespace understudy::machine {
namespace {

kinematics::ChainDescription described(const char* name) { return load_machine(name).chain().kinematics; }

TEST(TablePlace, AnArmStandsUprightAllOverItsTable) {
  for (const char* name : {"offset-wrist-arm", "arm"}) {
    kinematics::ChainDescription arm = described(name);
    arm.kind = "chain";
    const TablePlace place = find_table_place(arm, 0.08);
    ASSERT_TRUE(place.found) << name;
    const auto mechanism = make_chain_mechanism(arm);
    const auto n = arm.chain.axes.size();
    for (const double x : {-0.08, 0.0, 0.08})
      for (const double y : {-0.08, 0.08}) {
        const Pose X_BT = make_pose(Quat::Identity(), Vec3(place.centre_B + Vec3(x, y, 0)));
        kinematics::AxisVector axes{};
        ASSERT_EQ(mechanism->inverse(X_BT, std::span(place.home).first(n), std::span(axes).first(n)),
                  kinematics::SolveStatus::ok);
        for (std::size_t i = 0; i < n; ++i) {
          EXPECT_GE(axes[i], arm.chain.axes[i].lower);
          EXPECT_LE(axes[i], arm.chain.axes[i].upper);
        }
        EXPECT_LE(mechanism->condition_number(X_BT, std::span(axes).first(n)), place.condition * 1.0001);
      }
    const Pose home = kinematics::forward(arm.chain, std::span(place.home).first(n));
    EXPECT_NEAR(home.translation().z() - place.centre_B.z(), 0.05, 1e-6) << "above the table";
    EXPECT_NEAR(home.linear()(2, 2), 1, 1e-9) << "upright";
  }
}

TEST(TablePlace, AToolThatCannotStandUprightHasNone) {
  kinematics::ChainDescription arm = described("offset-wrist-arm");
  arm.chain.axes.resize(2);  // two axes that cannot turn the tool up
  arm.chain.tool_axis = 1;
  const TablePlace place = find_table_place(arm, 0.08);
  EXPECT_FALSE(place.found);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_DOUBLE_EQ(place.home[i], 0.5 * (arm.chain.axes[i].lower + arm.chain.axes[i].upper));
}

}  // namespace
}  // namespace understudy::machine
