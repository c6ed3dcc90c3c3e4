// Programs that state the turns of some axes of a chain, and the place of the tip or of the slides: the other
// axes follow.
//
// Either three slides follow the tip, wherever they stand in the chain: the tip's place is linear in them. Or
// an arm does, whose table is turned by all the words: its tool keeps the orientation of home in the frame O.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

/// Why the words of this description cannot be followed; empty where they can. Axes and signs are valid.
std::string turns_problem(const ChainDescription& description);

/// Of a description with turn_words and without such a problem; it must outlive this object. None of the
/// functions allocates or throws; numbers are finite.
class ChainTurns {
 public:
  explicit ChainTurns(const ChainDescription& description);

  SolveStatus pose_at_turns(const RotaryTarget& at, Pose& X_ST) const;
  void parts_at_turns(const RotaryTarget& at, Mat3& table, Mat3& head) const;
  SolveStatus pose_at_slides(const RotaryTarget& at, Pose& X_ST) const;
  SolveStatus slides_at_turns(const RotaryTarget& at, Vec3& slides) const;
  SolveStatus axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                            std::span<double> axis_rates) const;

 private:
  /// The words at their readings, the slides that follow at 0, all else at home.
  AxisVector turned(const RotaryTarget& at) const;
  AxisVector word_rates(const RotaryTarget& rate) const;
  Mat3 slide_columns(const ChainJacobian& jacobian) const;
  SolveStatus follow_by_slides(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                               std::span<double> axis_rates) const;
  SolveStatus follow_by_arm(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                            std::span<double> axis_rates) const;

  const ChainDescription& description_;
  const Chain& chain_;
  Pose X_OT_home_;                       // of the tool's branch alone
  std::array<std::size_t, 3> follow_{};  // slides that no word turns
  // Where an arm follows: its axes alone, whose work is the frame O, and their places in the chain.
  std::unique_ptr<Mechanism> arm_;
  std::vector<std::size_t> arm_axes_;
};

}  // namespace understudy::kinematics
