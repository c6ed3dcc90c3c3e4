#include "calibration/machine/plausibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "calibration/machine/measurement_columns.h"
#include "core/error.h"
#include "core/quantile.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

// No machine is built so far from its drawing; a wrong unit, frame or row is farther off in most poses.
constexpr double kFar = 50e-3;          // [m]
constexpr double kTurned = 0.3;         // [rad]
constexpr double kBeyondRange = 25e-3;  // [m], of a strut outside its limits
constexpr double kMuchNearer = 5;       // by this factor another unit must explain the poses better

struct Unit {
  const char* name;
  double factor;  ///< of the numbers as they were read
};
constexpr Unit kLengths[] = {{"metres", 1000}, {"inches", 25.4}, {"micrometres", 1e-3}};

double distance(const Pose& a, const Pose& b) { return (a.translation() - b.translation()).norm(); }

/// Where the machine would stand by its own model; false where it has no answer.
bool reached(const machine::MachineDescription& machine, const kinematics::Mechanism& mechanism,
             const MeasuredPose& pose, double axis_factor, Pose& X_WT) {
  std::vector<double> axes = pose.axes;
  for (double& axis : axes) axis *= axis_factor;
  Pose X_BT;
  if (mechanism.forward(axes, mechanism.home(), X_BT) != kinematics::SolveStatus::ok) return false;
  X_WT = machine.X_WB * X_BT;
  return true;
}

/// Strut lengths by their limits.
void check_struts(const Measurements& m, const machine::MachineDescription& machine) {
  const kinematics::HexapodLimits& limits = machine.hexapod().limits;
  const double low = limits.strut_min - kBeyondRange, high = limits.strut_max + kBeyondRange;
  const auto columns = axis_columns(machine);
  const auto within = [&](double l) { return l >= low && l <= high; };
  for (const MeasuredPose& pose : m.poses) {
    for (std::size_t i = 0; i < pose.axes.size(); ++i) {
      const double length = pose.axes[i];
      if (within(length)) continue;
      std::string guess;
      for (const Unit& unit : kLengths)
        if (guess.empty() && within(unit.factor * length))
          guess = fmt::format(": {} given for millimetres?", unit.name);
      if (guess.empty() && within(length + machine.hexapod().geometry.length_offset[i]))
        guess = ": a displacement of the drive given for the strut's length?";
      throw InputError(
          {m.file, pose.line, 0},
          fmt::format("{} is {:g} mm, where this machine's struts are {:g} to {:g} mm long{}", columns[i],
                      to_mm(length), to_mm(limits.strut_min), to_mm(limits.strut_max), guess));
    }
  }
}

/// Angles given in radians read as hundredths of a turn: poses then hardly differ.
void check_angle_unit(const Measurements& m, const machine::MachineDescription& machine,
                      const kinematics::Mechanism& mechanism) {
  std::vector<double> as_read, as_radians;
  for (const MeasuredPose& pose : m.poses) {
    Pose X;
    if (reached(machine, mechanism, pose, 1, X)) as_read.push_back(distance(X, pose.X_WT));
    if (reached(machine, mechanism, pose, 1 / kDegree, X)) as_radians.push_back(distance(X, pose.X_WT));
  }
  if (as_read.empty() || as_radians.empty() || quantile(as_read, 0.5) < kFar) return;
  if (kMuchNearer * quantile(as_radians, 0.5) < quantile(as_read, 0.5))
    throw InputError(
        {m.file, m.poses.front().line, 0},
        "axis angles fit the measured poses only if they are radians: radians given for degrees?");
}

/// Half of the poses decide, so that a plain wrong one is left to the estimator.
void check_pose_unit(const Measurements& m, const std::vector<Pose>& expected) {
  std::vector<double> as_read;
  for (std::size_t j = 0; j < expected.size(); ++j) as_read.push_back(distance(expected[j], m.poses[j].X_WT));
  const double typical = quantile(as_read, 0.5);
  if (typical < kFar / 2) return;
  for (const Unit& unit : kLengths) {
    std::vector<double> scaled;
    for (std::size_t j = 0; j < expected.size(); ++j)
      scaled.push_back((expected[j].translation() - unit.factor * m.poses[j].X_WT.translation()).norm());
    if (quantile(scaled, 0.5) < kFar && kMuchNearer * quantile(scaled, 0.5) < typical)
      throw InputError({m.file, m.poses.front().line, 0},
                       fmt::format("x_mm, y_mm, z_mm fit the axes only if they are {0}: {0} given for "
                                   "millimetres?",
                                   unit.name));
  }
  if (typical > kFar)
    throw InputError(
        {m.file, m.poses.front().line, 0},
        fmt::format("measured tips are {:.0f} mm (median) from where this machine's geometry puts "
                    "them, more than {:.0f} mm: another frame, machine or order of rows?",
                    to_mm(typical), to_mm(kFar)));
}

void check_orientation(const Measurements& m, const std::vector<Pose>& expected) {
  std::vector<double> turned, last_first;
  for (std::size_t j = 0; j < expected.size(); ++j) {
    const Mat3& R = m.poses[j].X_WT.linear();
    const Quat q(R);
    turned.push_back(angle_between(R, expected[j].linear()));
    // Read as w, x, y, z what was written as x, y, z, w.
    last_first.push_back(
        angle_between(Quat(q.z(), q.w(), q.x(), q.y()).toRotationMatrix(), expected[j].linear()));
  }
  if (quantile(turned, 0.5) < kTurned) return;
  throw InputError(
      {m.file, m.poses.front().line, 0},
      fmt::format("measured orientations are {:.0f} deg (median) from where this machine's geometry "
                  "puts them{}",
                  to_deg(quantile(turned, 0.5)),
                  kMuchNearer * quantile(last_first, 0.5) < quantile(turned, 0.5)
                      ? ": quaternions in the order x, y, z, w given for w, x, y, z?"
                      : ": another frame, machine or order of rows?"));
}

bool some_axis_stands_still(const Measurements& m, int axes) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i) {
    const auto same = [&](const MeasuredPose& pose) { return pose.axes[i] == m.poses.front().axes[i]; };
    if (std::all_of(m.poses.begin(), m.poses.end(), same)) return true;
  }
  return false;
}

}  // namespace

void check_plausible(const Measurements& m, const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  // Poses and axes cannot fit then; which axis it is, the check of what can be known says.
  if (some_axis_stands_still(m, mechanism->axis_count())) return;
  if (!machine.is_chain())
    check_struts(m, machine);
  else if (mechanism->axis_is_angle(0))
    check_angle_unit(m, machine, *mechanism);
  Measurements known = m;
  known.poses.clear();
  std::vector<Pose> expected;
  for (const MeasuredPose& pose : m.poses) {
    Pose X;
    if (!reached(machine, *mechanism, pose, 1, X)) continue;  // an outlier, which an estimator may reject
    expected.push_back(X);
    known.poses.push_back(pose);
  }
  if (2 * expected.size() < m.poses.size())
    throw InputError({m.file, m.poses.front().line, 0},
                     fmt::format("only {} of {} rows have axis positions that this machine's geometry can "
                                 "take: another machine?",
                                 expected.size(), m.poses.size()));
  check_pose_unit(known, expected);
  check_orientation(known, expected);
}

}  // namespace understudy::calibration
