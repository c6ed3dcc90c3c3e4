#include "studies/workspace/workspace_study.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "core/units.h"

namespace understudy::studies {
namespace {

using Box = std::array<double, 6>;

void expect_box(const Box& box, const Box& expected_mm) {
  // 1e-9 mm: boxes are told to the nanometre.
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(to_mm(box[i]), expected_mm[i], 1e-9) << i;
}

TEST(WorkspaceStudy, BoxesComeFromTheMachine) {
  // home_tip_mm [0, 0, 50]; table and z range of models/*/machine.yaml.
  expect_box(default_workspace_box(machine::load_machine("hexapod")), {-50, 50, -50, 50, 0, 100});
  expect_box(default_workspace_box(machine::load_machine("five-axis")), {-75, 75, -75, 75, 0, 200});
  expect_box(default_workspace_box(machine::load_machine("finishing")), {-90, 90, -90, 90, 0, 400});
  expect_box(default_workspace_box(machine::load_machine("arm")), {-100, 100, -100, 100, 0, 200});
}

TEST(WorkspaceStudy, WithoutOptionsTheToolIsAsAtHome) {
  for (const char* name : {"hexapod", "arm", "five-axis", "finishing"}) {
    const auto machine = machine::load_machine(name);
    const auto study = plan_workspace(machine, {});
    ASSERT_EQ(study.request.orientations.size(), 1u);
    const Mat3 R_home = (machine.X_WB * machine.X_BT_home).linear();
    // 1e-12: a few roundings.

    EXPECT_LT((study.request.orientations[0] - R_home).norm(), 1e-12) << name;
  }
  const auto finishing = plan_workspace(machine::load_machine("finishing"), {});
  EXPECT_NEAR(to_deg(finishing.tilt), 90, 1e-9) << "its end mill lies level at home";
}

TEST(WorkspaceStudy, LeansTowardsTheAzimuth) {
  WorkspaceOptions options;
  options.tilt = from_deg(30);
  options.azimuth = from_deg(90);
  const auto study = plan_workspace(machine::load_machine("hexapod"), options);
  const Vec3 axis = study.request.orientations[0].col(2);
  EXPECT_LT((axis - Vec3(0, 0.5, std::sqrt(0.75))).norm(), 1e-12);
  options.all_azimuths = true;
  const auto all = plan_workspace(machine::load_machine("hexapod"), options);
  ASSERT_EQ(all.request.orientations.size(), 12u);
  Vec3 sum = Vec3::Zero();
  for (const Mat3& R : all.request.orientations) sum += R.col(2);
  EXPECT_LT((sum / 12 - Vec3(0, 0, std::sqrt(0.75))).norm(), 1e-12) << "evenly around";
}

TEST(WorkspaceStudy, LimitsReadAsSentences) {
  using kinematics::LimitKind;
  const auto text = [](LimitKind kind, const char* part, bool above, double limit, const char* unit) {
    kinematics::WorkspaceLimit l;
    l.kind = kind, l.part = part, l.above = above, l.limit = limit, l.unit = unit;
    return limit_text(l);
  };
  EXPECT_EQ(text(LimitKind::joint_angle, "ball joint 3", true, from_deg(120), "rad"),
            "ball joint 3 above 120 deg");
  EXPECT_EQ(text(LimitKind::strut_length, "strut", false, 0.17, "m"), "strut shorter than 170 mm");
  EXPECT_EQ(text(LimitKind::screw_distance, "struts", false, 0.01, "m"), "struts nearer than 10 mm");
  EXPECT_EQ(text(LimitKind::singularity, "platform", true, 25, "1"), "platform condition above 25");
  EXPECT_EQ(text(LimitKind::unreachable, "tool pose", false, 0, ""), "tool pose out of reach");
}

}  // namespace
}  // namespace understudy::studies
