#include "sim/plant/hexapod_assembly.h"

#include <fmt/format.h>

#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "sim/as_built/as_built_file.h"

namespace understudy::sim {

using kinematics::kStruts;

kinematics::ScrewCoupling built_screw_coupling(const machine::MachineDescription& machine) {
  const machine::HexapodModel& hexapod = machine.hexapod();
  return kinematics::screw_coupling(machine.calibration ? hexapod.design : hexapod.geometry, hexapod.joints,
                                    machine.X_BT_home, machine.screw_coupling().lead);
}

ScrewTurning::ScrewTurning(const machine::MachineDescription& machine, const AsBuilt& as_built)
    : geometry_(as_built.hexapod), coupling_(built_screw_coupling(machine)), X_BW_(machine.X_WB.inverse()) {}

double ScrewTurning::growth(const Pose& X_WT, int strut) const {
  if (coupling_.lead == 0) return 0;
  double angle = 0;
  if (kinematics::passive_rotation(geometry_, coupling_, X_BW_ * X_WT, strut, angle) !=
      kinematics::SolveStatus::ok)
    throw MachineError(fmt::format(
        "strut {} lies along one of its joints: the turn of its screw is not defined", strut + 1));
  return coupling_.lead / (2 * std::numbers::pi) * angle;
}

Pose assemble_hexapod(const machine::MachineDescription& machine, const AsBuilt& as_built,
                      const kinematics::AxisVector& displacement) {
  kinematics::StrutLengths lengths{};
  for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = displacement[i] + as_built.hexapod.length_offset[i];
  const auto found =
      kinematics::forward(as_built.hexapod, built_screw_coupling(machine), lengths, machine.X_BT_home);
  if (found.status != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format(
        "the loops cannot be closed for strut lengths {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} mm: {}",
        to_mm(lengths[0]), to_mm(lengths[1]), to_mm(lengths[2]), to_mm(lengths[3]), to_mm(lengths[4]),
        to_mm(lengths[5]), kinematics::to_string(found.status)));
  return machine.X_WB * found.X_BT;
}

kinematics::AxisVector home_displacement(const machine::MachineDescription& machine,
                                         const AsBuilt& as_built) {
  kinematics::StrutLengths lengths{};
  if (kinematics::inverse(as_built.hexapod, built_screw_coupling(machine), machine.X_BT_home, lengths) !=
      kinematics::SolveStatus::ok)
    throw MachineError("the as-built machine does not reach its home pose");
  kinematics::AxisVector displacement{};
  for (std::size_t i = 0; i < kStruts; ++i) displacement[i] = lengths[i] - as_built.hexapod.length_offset[i];
  return displacement;
}

void check_stands_at_home(const machine::MachineDescription& machine, const AsBuilt& as_built) {
  if (machine.is_chain()) return;
  try {
    static_cast<void>(assemble_hexapod(machine, as_built, home_displacement(machine, as_described(machine))));
  } catch (const MachineError& error) {
    const std::string file = file_of(as_built);
    throw InputError(Place{file.empty() ? machine.file.string() : file},
                     fmt::format("with its drives where the machine file has them at home, {}; are these the "
                                 "errors of another machine?",
                                 error.what()));
  }
}

}  // namespace understudy::sim
