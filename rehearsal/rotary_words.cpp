#include "rehearsal/rotary_words.h"

#include <memory>

#include "core/assert.h"

namespace understudy::rehearsal {
namespace {

using kinematics::SolveStatus;

void expect_ok(SolveStatus status) {
  UNDERSTUDY_ASSERT(status == SolveStatus::ok,
                    "a program's numbers are finite, and the mechanism has rotary words");
}

}  // namespace

std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine) {
  const std::shared_ptr<const kinematics::Mechanism> mechanism = machine.make_mechanism();
  const auto words = mechanism->rotary_words();
  if (words.empty()) return std::nullopt;
  const Pose X_WB = machine.X_WB, X_BW = X_WB.inverse();
  toolpath::RotaryWords rotary;
  rotary.letters = {words[0].letter, words[1].letter};
  rotary.b_home = words[0].home;
  rotary.c_home = words[1].home;
  rotary.tip_pose = [mechanism, X_WB, X_BW](const Vec3& p_WT, double b, double c) -> Pose {
    Pose X_BT = Pose::Identity();
    expect_ok(mechanism->pose_at_turns({X_BW * p_WT, b, c}, X_BT));
    return X_WB * X_BT;
  };
  rotary.slides_pose = [mechanism, X_WB](const Vec3& slides, double b, double c) -> Pose {
    Pose X_BT = Pose::Identity();
    expect_ok(mechanism->pose_at_slides({slides, b, c}, X_BT));
    return X_WB * X_BT;
  };
  rotary.slides = [mechanism, X_BW](const Vec3& p_WT, double b, double c) -> Vec3 {
    Vec3 slides = Vec3::Zero();
    expect_ok(mechanism->slides_at_turns({X_BW * p_WT, b, c}, slides));
    return slides;
  };
  return rotary;
}

}  // namespace understudy::rehearsal
