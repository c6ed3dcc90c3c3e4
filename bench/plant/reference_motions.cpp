#include "bench/plant/reference_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/load_flips.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using std::numbers::pi;

/// 0 to 1 over [0, duration], with no velocity or acceleration at the ends.
double blend(double t, double duration) {
  const double s = std::clamp(t / duration, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

/// Turns of a motion that takes `period` for one and reaches its speed, and loses it, within `ramp`: s(t)
/// with s' rising as a half cosine.
double turns(double t, double period, double ramp, double duration) {
  const auto risen = [&](double x) {  // integral of (1 - cos(pi x / ramp)) / 2
    if (x <= 0) return 0.0;
    if (x >= ramp) return x - ramp / 2;
    return x / 2 - ramp / (2 * pi) * std::sin(pi * x / ramp);
  };
  return (risen(t) - risen(t - (duration - ramp))) / period;
}

/// Axes at a pose, and on the branch of `axes`.
void solve(const kinematics::Mechanism& mechanism, const Pose& X_BT, double time, AxisVector& axes) {
  const auto count = static_cast<std::size_t>(mechanism.axis_count());
  const AxisVector previous = axes;
  const auto status = mechanism.inverse(X_BT, std::span(previous).first(count), std::span(axes).first(count));
  if (status != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format("the motion is {} at {:.3f} s", kinematics::to_string(status), time));
}

}  // namespace

ReferenceMotion circle_at_15_degrees(const machine::MachineDescription& machine) {
  ReferenceMotion motion{"circle 20 mm at 15 deg", 3.0, {}};
  const Pose home = machine.X_BT_home;
  motion.X_BT = [home](double t) {
    const double angle = 2 * pi * turns(t, 2.0, 0.5, 3.0);
    Pose X_BT = home;
    X_BT.linear() = exp_rotation(Vec3(from_deg(15), 0, 0));
    X_BT.translation() += from_mm(20) * Vec3(std::cos(angle), std::sin(angle), 0);
    return X_BT;
  };
  return motion;
}

ReferenceMotion tilt_sweep(const machine::MachineDescription& machine) {
  ReferenceMotion motion{"tilt sweep to 20 deg", 4.0, {}};
  const Pose home = machine.X_BT_home;
  motion.X_BT = [home](double t) {
    const double angle = from_deg(20) * (blend(t, 2.0) - blend(t - 2.0, 2.0));
    Pose X_BT = home;
    X_BT.linear() = exp_rotation(Vec3(angle, 0, 0));
    X_BT.translation().y() -= from_mm(20);
    return X_BT;
  };
  return motion;
}

ReferenceMotion zigzag(const machine::MachineDescription& machine, double acceleration) {
  constexpr double kAmplitude = from_mm(8);
  const double rate = std::sqrt(acceleration / kAmplitude), duration = 6 * 2 * pi / rate;
  ReferenceMotion motion{fmt::format("zigzag at {:.0f} m/s2", acceleration), duration, {}};
  const Pose home = machine.X_BT_home;
  motion.X_BT = [home, rate, duration](double t) {
    const double swing = blend(t, duration / 3) * blend(duration - t, duration / 3);
    Pose X_BT = home;
    X_BT.translation() +=
        Vec3(kAmplitude * swing * std::sin(rate * t), from_mm(4) * (blend(t, duration) - 0.5), 0);
    return X_BT;
  };
  return motion;
}

ReferenceMotion arm_path(const machine::MachineDescription& machine) {
  ReferenceMotion motion{"arm path", 5.0, {}};
  const Pose home = machine.X_BT_home;
  motion.X_BT = [home](double t) {
    const double angle = 2 * pi * turns(t, 4.0, 1.0, 5.0);
    Pose X_BT = home;
    X_BT.translation() += from_mm(60) * Vec3(std::cos(angle) - 1, std::sin(angle), 0.5 * std::sin(2 * angle));
    X_BT.linear() =
        exp_rotation(from_deg(20) * Vec3(std::sin(angle), 1 - std::cos(angle), 0)) * home.linear();
    return X_BT;
  };
  return motion;
}

AsBuilt built_with_play(const machine::MachineDescription& machine, double travel) {
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.nut_play.fill(travel * 2 / 3);
  built.ball_play.fill(travel / 3);
  built.axis_play.fill(travel);
  return built;
}

CommandStream command_stream(const machine::MachineDescription& machine, const ReferenceMotion& motion,
                             double timestep) {
  constexpr double kHalf = 1e-5;  // [s], of the difference quotient: exact to 1e-11 of a length
  const auto mechanism = machine.make_mechanism();
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  const auto zero = machine.drive_zero();
  CommandStream stream;
  AxisVector axes{};
  if (machine.is_chain()) std::copy_n(machine.chain().kinematics.home.begin(), count, axes.begin());
  const auto steps = static_cast<int>(std::lround(motion.duration / timestep));
  for (int k = 0; k < steps; ++k) {
    const double t = k * timestep;
    solve(*mechanism, motion.X_BT(t), t, axes);
    AxisVector before = axes, after = axes;
    solve(*mechanism, motion.X_BT(t - kHalf), t, before);
    solve(*mechanism, motion.X_BT(t + kHalf), t, after);
    DriveCommand command;
    for (std::size_t i = 0; i < count; ++i) {
      command.position[i] = axes[i] - zero[i];
      command.velocity[i] = (after[i] - before[i]) / (2 * kHalf);
    }
    stream.commands.push_back(command);
    const auto tip = [&](double at) { return Vec3(machine.X_WB * motion.X_BT(at).translation()); };
    stream.tip_W.push_back(tip(t + timestep));
    const Vec3 change = tip(t + timestep) - 2 * tip(t) + tip(t - timestep);
    stream.largest_acceleration =
        std::max(stream.largest_acceleration, change.norm() / (timestep * timestep));
  }
  return stream;
}

MotionTrace run(Plant& plant, const CommandStream& stream) {
  MotionTrace trace;
  plant.reset(stream.commands.front().position);
  for (const DriveCommand& command : stream.commands) {
    plant.step(command);
    trace.tip_W.push_back(plant.tool_pose().translation());
    trace.load.push_back(plant.drive_force());
  }
  return trace;
}

std::vector<double> distances(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::vector<double> result;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) result.push_back((a[k] - b[k]).norm());
  return result;
}

double peak(const std::vector<double>& distances) {
  return *std::max_element(distances.begin(), distances.end());
}

double median(std::vector<double> distances) {
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

int load_flips(const MotionTrace& trace, double timestep, int axes) {
  LoadFlips flips(axes);
  for (std::size_t k = 0; k < trace.load.size(); ++k)
    flips.add(static_cast<double>(k) * timestep, trace.load[k]);
  return static_cast<int>(flips.count());
}

}  // namespace understudy::sim
