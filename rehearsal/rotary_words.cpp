#include "rehearsal/rotary_words.h"

#include "kinematics/chain/five_axis.h"

namespace understudy::rehearsal {

// Its axes carry the work, on which the world stands: W is the kinematics' S.
std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine) {
  if (machine.mechanism != "five-axis" || !machine.is_chain()) return std::nullopt;
  const kinematics::ChainDescription& chain = machine.chain().kinematics;
  const std::vector<double>& p = chain.parameters;
  const kinematics::FiveAxisGeometry geometry{p[0], p[1], p[2], p[3]};
  toolpath::RotaryWords words;
  words.b_home = chain.home[3];
  words.c_home = chain.home[4];
  words.tip_pose = kinematics::five_axis_tip_pose;
  words.slides_pose = [geometry](const Vec3& slides, double b, double c) -> Pose {
    return kinematics::five_axis_pose(geometry, {slides.x(), slides.y(), slides.z(), b, c});
  };
  words.slides = [geometry](const Vec3& p_WT, double b, double c) -> Vec3 {
    const kinematics::FiveAxes axes = kinematics::five_axis_at_tip(geometry, p_WT, b, c);
    return {axes[0], axes[1], axes[2]};
  };
  return words;
}

}  // namespace understudy::rehearsal
