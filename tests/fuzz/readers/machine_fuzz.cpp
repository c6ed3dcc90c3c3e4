// Bytes as a machine file.
#include <cmath>

#include "machine/accepted_errors.h"
#include "machine/built_tolerances.h"
#include "machine/calibrated_parameters.h"
#include "machine/description.h"
#include "machine/file/calibration_section.h"
#include "machine/file/gap_sensor_section.h"
#include "tests/fuzz/chain_check.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

using machine::MachineDescription;

std::vector<double> axes_of(const MachineDescription& machine, const kinematics::AxisVector& all) {
  const auto count = static_cast<std::size_t>(machine.make_mechanism()->axis_count());
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// What every user of a description asks first.
void check_numbers(const MachineDescription& m) {
  require_finite(m.X_WB, "X_WB");
  require_finite(m.X_BT_home, "X_BT_home");
  require_finite(axes_of(m, m.drive_zero()), "drive zero");
  require_finite(std::vector{m.cycle_time, m.travel_velocity, m.orientation_velocity, m.acceleration,
                             m.tip_play(), m.gap.aim, m.gap.standoff},
                 "a number of the machine");
  require(m.cycle_time > 0 && m.travel_velocity > 0 && m.acceleration > 0,
          "a limit of motion that is not above 0");
  for (std::size_t i = 0; i < axes_of(m, {}).size(); ++i) {
    const machine::Drive& drive = m.drives[i];
    require_finite(std::vector{drive.step(), drive.velocity_max, drive.acceleration_max, drive.rotor()},
                   "drive");
    require(drive.step() > 0 && drive.velocity_max > 0 && drive.acceleration_max > 0,
            "a drive that cannot move");
  }
}

/// At home, where a machine starts, axes and pose belong to each other or a status says why not.
void check_home(const MachineDescription& m) {
  using kinematics::SolveStatus;
  const auto mechanism = m.make_mechanism();
  const Pose home = mechanism->home();
  require_finite(home, "home");
  std::vector<double> axes(static_cast<std::size_t>(mechanism->axis_count()), 0.0);
  std::vector<kinematics::LimitViolation> violations;
  if (mechanism->inverse(home, {}, axes) == SolveStatus::ok) {
    require_finite(axes, "axes at home");
    Pose back;
    if (mechanism->forward(axes, home, back) == SolveStatus::ok)
      require_near((back.translation() - home.translation()).norm(), 0, 1e-6, 0, "tip at home");
    mechanism->check(home, axes, violations);
    require(!std::isnan(mechanism->condition_number(home, axes)), "a condition number that is none");
  } else {
    mechanism->check(home, {}, violations);
  }
  for (const auto& violation : violations) {
    require(!std::isnan(violation.value) && !std::isnan(violation.limit), "a limit that is none");
    require(!to_string(violation).empty(), "a limit without words");
  }
}

void require_same(const Pose& read, const Pose& written, const std::string& what) {
  require_near((read.translation() - written.translation()).norm(), 0, 1e-11, 1e-11, what + ": place");
  require_near(angle_between(read.linear(), written.linear()), 0, 1e-8, 0, what + ": turn");
}

/// A calibrated machine's section is written and read back.
void check_calibration(const MachineDescription& m, const machine::CalibratedParameters& parameters,
                       std::string_view text) {
  if (!m.calibration) return;
  static const InputFile written("calibrated.yaml");
  written.fill(machine::with_section(std::string(text), machine::calibration_section(m, parameters)));
  machine::CalibratedParameters again;
  const MachineDescription read = machine::load_machine(written.path().string(), again);
  require(read.calibration->estimator == m.calibration->estimator, "another estimator came back");
  require(read.calibration->poses == m.calibration->poses, "another number of poses came back");
  require(again.covariance.rows() == parameters.covariance.rows(), "another covariance came back");
  if (m.is_chain()) {
    require_same(read.chain().kinematics.chain.X_OT_zero, m.chain().kinematics.chain.X_OT_zero, "tool");
    require_same(read.chain().kinematics.chain.X_OS_zero, m.chain().kinematics.chain.X_OS_zero, "work");
    return;
  }
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    const auto &r = read.hexapod().geometry, &w = m.hexapod().geometry;
    require_near((r.base_joint[i] - w.base_joint[i]).norm(), 0, 1e-11, 0, "base joint");
    require_near((r.platform_joint[i] - w.platform_joint[i]).norm(), 0, 1e-11, 0, "platform joint");
    require_near(r.length_offset[i], w.length_offset[i], 1e-11, 0, "length offset");
  }
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("machine.yaml");
  const std::string_view text = fuzz::text_of(data, size);
  const std::string file = input.fill(text).string();
  machine::MachineDescription machine;
  machine::CalibratedParameters parameters;
  if (!fuzz::accepts(size, file, [&] { machine = machine::load_machine(file, parameters); })) return 0;
  fuzz::check_numbers(machine);
  fuzz::check_home(machine);
  // Rods that carry the tool close loops, which no URDF holds.
  if (machine.is_chain() && machine.chain().kinematics.chain.rods.empty())
    fuzz::check_urdf_of(machine.chain().kinematics.chain, {}, {});
  fuzz::check_calibration(machine, parameters, text);
  machine::load_built_tolerances(file);
  machine::load_accepted_errors(file);
  return 0;
}
