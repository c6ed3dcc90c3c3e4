// What a controller has to be asked for, so that a machine which differs from its belief takes a pose.
#pragma once

#include <memory>
#include <optional>

#include "kinematics/mechanism.h"
#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::control {

/// A pose as a controller is asked for it.
struct NominalCommand {
  Pose X_WT = Pose::Identity();
  std::optional<toolpath::RotaryTurns> rotary = std::nullopt;  ///< of a goal that has them
};

/// The controller reckons with `nominal`, the machine is as `known` says; its drives do what they are told.
///   drive = inverse_known(goal) - zero_known;   command = forward_nominal(drive + zero_nominal).
class CommandMap {
 public:
  /// Both are one machine, with the same axes (rehearsal/before_calibration.h); they must outlive this.
  CommandMap(const machine::MachineDescription& nominal, const machine::MachineDescription& known);

  /// The command for a tool at X_WT. Keeps the axes as the start of the next solution. Where the machine
  /// leaves the tool's spin free and the exact tool axis would take a leap of its axes, or no axes make it,
  /// the tip alone is put right and the turning axes stay as the controller has them.
  kinematics::SolveStatus command(const Pose& X_WT, const std::optional<toolpath::RotaryTurns>& rotary,
                                  NominalCommand& command);
  /// Where the known machine has its tool for axes as the controller has them, without play.
  kinematics::SolveStatus tool_at(const kinematics::AxisVector& nominal_axes, Pose& X_WT);

 private:
  kinematics::SolveStatus nominal_axes(const Pose& X_WT, const std::optional<toolpath::RotaryTurns>& rotary);
  kinematics::SolveStatus solve_known(const Pose& X_BT, const kinematics::AxisVector& near,
                                      kinematics::AxisVector& axes) const;
  kinematics::SolveStatus put_tip_right(const Pose& X_BT, kinematics::AxisVector& axes) const;
  kinematics::AxisVector shifted(const kinematics::AxisVector& axes, double sign) const;

  std::unique_ptr<kinematics::Mechanism> nominal_, known_;
  Pose X_WB_, X_BW_;
  kinematics::AxisVector zero_;  ///< known less nominal
  kinematics::AxisVector axes_{};
  Pose X_BT_command_, X_BT_known_;
};

}  // namespace understudy::control
