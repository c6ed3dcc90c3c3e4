// What is exported is what the plant runs: MuJoCo reads it and finds the machine in it.
#include "sim/plant/mujoco/mjcf.h"

#include <gtest/gtest.h>

#include "sim/plant/mujoco/mujoco_engine.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/small_chains.h"

namespace understudy::sim {
namespace {

class Mjcf : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    options_.play = GetParam();
    X_WT_ = machine_.X_WB * machine_.X_BT_home *
            make_pose(exp_rotation(Vec3(0.1, -0.2, 0.05)), Vec3(0.01, 0, 0.004));
    model_ = load_model(write_mjcf(machine_, built_, X_WT_, options_));
    data_ = make_data(*model_);
    mj_forward(model_.get(), data_.get());
  }

  machine::MachineDescription machine_ = machine_g4();
  AsBuilt built_ = make_as_built(machine_, "manufactured", 9);
  MujocoOptions options_;
  Pose X_WT_;
  ModelPointer model_;
  DataPointer data_;
};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutPlay, Mjcf, testing::Bool());

TEST_P(Mjcf, HasTheJointsOfTheMachine) {
  // Free platform; universal joint and screw a strut; nut and ball play.
  EXPECT_EQ(model_->nv, 6 + 6 * (2 + 1 + (options_.play ? 2 : 0)));
  EXPECT_EQ(model_->neq, 6 + 6);
}

TEST_P(Mjcf, HasTheMassesOfTheDescription) {
  EXPECT_NEAR(mj_getTotalmass(model_.get()),
              machine_.hexapod().masses.platform +
                  6 * (machine_.hexapod().masses.motor + machine_.hexapod().masses.nut),
              1e-12);
  const int platform = find_id(*model_, mjOBJ_BODY, kPlatformBody);
  EXPECT_EQ(model_->body_mass[platform], machine_.hexapod().masses.platform);
  const Vec3 centre(data_->xipos + 3 * platform);
  EXPECT_LE((centre - X_WT_ * machine_.hexapod().masses.platform_centre_T).norm(), 1e-12);
}

TEST_P(Mjcf, IsAssembledAtThePose) {
  const Vec3 tip(data_->site_xpos + 3 * find_id(*model_, mjOBJ_SITE, "tip"));
  EXPECT_LE((tip - X_WT_.translation()).norm(), 1e-12);
  // MuJoCo takes the far anchors of a closure from where the bodies are: compare them with the as-built
  // balls.
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const int nut = find_id(*model_, mjOBJ_BODY, strut_part(i, "nut"));
    EXPECT_LE((Vec3(data_->xpos + 3 * nut) - X_WT_ * built_.hexapod.platform_joint[s]).norm(), 1e-12);
    const int motor = find_id(*model_, mjOBJ_BODY, strut_part(i, "motor"));
    EXPECT_LE((Vec3(data_->xpos + 3 * motor) - machine_.X_WB * built_.hexapod.base_joint[s]).norm(), 1e-12);
    EXPECT_LE(Eigen::Map<const Vec3>(data_->efc_pos + 3 * i).norm(), 1e-12);
  }
}

TEST_P(Mjcf, ScrewStandsOffTheUniversalJointByDev) {
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const int screw = find_id(*model_, mjOBJ_JOINT, strut_part(i, kScrewPart));
    const int alpha = find_id(*model_, mjOBJ_JOINT, strut_part(i, "alpha"));
    const int beta = find_id(*model_, mjOBJ_JOINT, strut_part(i, "beta"));
    const Vec3 axis(data_->xaxis + 3 * screw), first(data_->xaxis + 3 * alpha),
        second(data_->xaxis + 3 * beta);
    const Vec3 from_joint = Vec3(data_->xanchor + 3 * screw) - Vec3(data_->xanchor + 3 * alpha);
    const Vec3 offset = from_joint - axis.dot(from_joint) * axis;
    EXPECT_NEAR(offset.norm(), machine_.hexapod().geometry.deviation, 1e-12);
    EXPECT_GT(offset.dot(machine_.X_WB.linear() *
                         machine_.hexapod().joints.radial_axis[static_cast<std::size_t>(i)]),
              0)
        << "the screws hang outside the circle of the universal joints";
    EXPECT_NEAR(axis.dot(second), 0, 1e-12);
    EXPECT_NEAR(first.dot(second), 0, 1e-12);
  }
}

// Characters that mean something in XML, and an element that an unescaped name would slip in.
constexpr const char* kHostileName = "R&D \"x\"><include file='x'/>";

TEST(MjcfNames, OfAHexapodAreEscaped) {
  machine::MachineDescription machine = machine_g4();
  machine.name = kHostileName;
  const auto model =
      load_model(write_mjcf(machine, make_as_built(machine, "nominal", 1), machine.X_WB * machine.X_BT_home));
  EXPECT_STREQ(model->names, kHostileName);
}

TEST(MjcfNames, OfAChainsAxesAreEscaped) {
  machine::MachineDescription machine = two_links(0.1, 0.2);
  machine.chain().kinematics.chain.axes[1].name = kHostileName;
  const auto model = load_model(write_mjcf(machine, make_as_built(machine, "nominal", 1), machine.X_BT_home));
  EXPECT_EQ(model->nq, 2);
  EXPECT_GE(find_id(*model, mjOBJ_JOINT, kHostileName), 0);
  EXPECT_GE(find_id(*model, mjOBJ_BODY, kHostileName), 0);
}

}  // namespace
}  // namespace understudy::sim
