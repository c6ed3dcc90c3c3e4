#include "rehearsal/before_calibration.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "core/error.h"
#include "rehearsal/findings/findings.h"

namespace understudy::rehearsal {
namespace {

using machine::MachineDescription;

constexpr double kSameLength = 1e-9;  // [m]; files tell a nanometre at best
constexpr double kSameTurn = 1e-9;    // [rad]

bool same(const Vec3& a, const Vec3& b, double tolerance) { return (a - b).norm() < tolerance; }

bool same(const Pose& a, const Pose& b) {
  return same(a.translation(), b.translation(), kSameLength) && a.linear().isApprox(b.linear(), kSameTurn);
}

bool same(const kinematics::HexapodGeometry& a, const kinematics::HexapodGeometry& b) {
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    if (!same(a.base_joint[i], b.base_joint[i], kSameLength) ||
        !same(a.platform_joint[i], b.platform_joint[i], kSameLength) ||
        std::abs(a.length_offset[i] - b.length_offset[i]) > kSameLength)
      return false;
  return std::abs(a.deviation - b.deviation) < kSameLength;
}

bool same(const kinematics::Chain& a, const kinematics::Chain& b) {
  const auto axes_agree = [](const kinematics::ChainAxis& p, const kinematics::ChainAxis& q) {
    return p.name == q.name && p.angle == q.angle && p.parent == q.parent &&
           same(p.direction, q.direction, kSameTurn) && same(p.point, q.point, kSameLength);
  };
  const auto rods_agree = [](double p, double q) { return std::abs(p - q) <= kSameLength; };
  return std::ranges::equal(a.axes, b.axes, axes_agree) && std::ranges::equal(a.rods, b.rods, rods_agree) &&
         same(a.X_OT_zero, b.X_OT_zero) && same(a.X_OS_zero, b.X_OS_zero);
}

const kinematics::Chain& drawn_chain(const MachineDescription& machine) {
  const auto& known = machine.chain().kinematics;
  return machine.calibration ? known.design : known.chain;
}

const char* difference(const MachineDescription& a, const MachineDescription& b) {
  if (a.name != b.name) return "another machine";
  const bool drawn_alike =
      a.is_chain() ? same(drawn_chain(a), drawn_chain(b)) : same(a.hexapod().design, b.hexapod().design);
  if (!drawn_alike) return "drawn differently";
  return same(a.X_WB, b.X_WB) ? nullptr : "placed differently";
}

std::string file_name(const std::string& machine) {
  return std::filesystem::path(machine).filename().string();
}

}  // namespace

void require_same_machine(const MachineDescription& before, const MachineDescription& after,
                          const std::string& before_said, const std::string& after_said) {
  if (before.mechanism != after.mechanism)
    throw InputError(fmt::format("{}: its mechanism is {}, that of {} is {}", before_said, before.mechanism,
                                 after_said, after.mechanism));
  if (const char* what = difference(before, after))
    throw InputError(fmt::format("{}: {} than {}; it must be the same machine, before its calibration",
                                 before_said, what, after_said));
  if (before.sha256 == after.sha256)
    throw InputError(
        fmt::format("{}: the same file as --machine {}: nothing to compare", before_said, after_said));
}

BeforeCalibration before_calibration(const TwinSetup& setup, const std::string& before,
                                     const std::string& after) {
  BeforeCalibration result{setup, file_name(before), file_name(after), {}};
  MachineDescription& machine = result.setup.machine;
  machine = machine::load_machine(before, result.setup.calibrated);
  machine.tool.nozzle_diameter = setup.machine.tool.nozzle_diameter;  // the one that is mounted
  machine.tool.flat_diameter = setup.machine.tool.flat_diameter;
  require_same_machine(machine, setup.machine, "--before " + before, after);
  for (const Finding& finding : findings_of(control::check_constraints(setup.program, machine)))
    if (finding.severity == Severity::error) {
      result.not_run = finding.message;
      if (finding.gcode_line > 0) result.not_run += fmt::format(" (line {})", finding.gcode_line);
      break;
    }
  return result;
}

std::optional<CalibrationFigures> compare_calibrations(const BeforeCalibration& before,
                                                       const TwinRun* before_run, const TwinRun& after_run) {
  if (!after_run.accuracy) return std::nullopt;
  CalibrationFigures figures{
      before.machine_before, before.machine_after, before.not_run, {}, *after_run.accuracy};
  if (before_run) figures.before = before_run->accuracy;
  return figures;
}

}  // namespace understudy::rehearsal
