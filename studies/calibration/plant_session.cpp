#include "studies/calibration/plant_session.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/drive_errors.h"
#include "studies/calibration/warming.h"

namespace understudy::studies {
namespace {

using machine::Setpoint;

constexpr double kSpeed = 30e-3, kTurnRate = 0.5;  // [m/s], [rad/s]
constexpr double kAcceleration = 0.3,
                 kTurnAcceleration = 5;  // [m/s^2], [rad/s^2]: loads stay the static ones
constexpr double kBeyond = 1e-3;         // [m]: ten times the play of a strut
constexpr double kTurnBeyond = from_deg(0.5);
constexpr double kPeriod = 10e-3;                   // [s], between setpoints
constexpr double kRestCheck = 0.1, kRestLimit = 4;  // [s]
// A strut whose load is 0 within its play swings there without end; nothing on a machine is that free. Then
// the middle of its swing is measured.
constexpr double kSwing = 100e-6;                     // [m], of the tool; the play of a strut
constexpr std::size_t kSwingChecks = 20;              // its last 2 s
constexpr double kTargetsLever = 30e-3;               // [m]
constexpr double kStill = 100e-9, kTurnStill = 2e-6;  // [m], [rad], within kRestCheck: what engines shake by
constexpr int kWarmingSteps = 60;                     // of the exponential, straight in between
constexpr double kWarmingConstants = 6;               // then 0.2 % is left

/// s(u) = 10 u^3 - 15 u^4 + 6 u^5: at rest, and without acceleration, at both ends.
struct Smooth {
  explicit Smooth(double u)
      : place(u * u * u * (10 + u * (6 * u - 15))), rate(30 * u * u * (1 + u * (u - 2))) {}
  double place, rate;
};
constexpr double kPeakRate = 1.875, kPeakAcceleration = 5.774;  // of the above

double move_time(const kinematics::Mechanism& mechanism, const std::vector<double>& from,
                 const std::vector<double>& to) {
  double time = kPeriod;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const bool angle = mechanism.axis_is_angle(static_cast<int>(i));
    const double distance = std::abs(to[i] - from[i]);
    time = std::max({time, kPeakRate * distance / (angle ? kTurnRate : kSpeed),
                     std::sqrt(kPeakAcceleration * distance / (angle ? kTurnAcceleration : kAcceleration))});
  }
  return time;
}

std::vector<double> beyond(const kinematics::Mechanism& mechanism, std::vector<double> axes, StopSide side) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const int axis = static_cast<int>(i);
    const double by = mechanism.axis_is_angle(axis) ? kTurnBeyond : kBeyond;
    const kinematics::AxisRange range = mechanism.axis_range(axis);
    axes[i] = std::clamp(axes[i] + (side == StopSide::lengthening ? -by : by), range.lower, range.upper);
  }
  return axes;
}

std::vector<double> home_axes(const machine::MachineDescription& machine,
                              const kinematics::Mechanism& mechanism) {
  std::vector<double> axes(static_cast<std::size_t>(mechanism.axis_count()));
  if (mechanism.inverse(machine.X_BT_home, {}, axes) != kinematics::SolveStatus::ok)
    throw InputError(machine.name + ": the home pose cannot be reached");
  return axes;
}

std::unique_ptr<sim::Plant> make_plant(const machine::MachineDescription& drawn, const sim::AsBuilt& built,
                                       const SessionOptions& options) {
  if (options.engine == "quasistatic") {
    sim::QuasistaticOptions own;
    own.gravity = options.gravity;
    own.play = options.play;
    return sim::with_drive_errors(sim::make_quasistatic_plant(drawn, built, own), drawn, built);
  }
  if (options.engine == "mujoco") {
    sim::MujocoOptions own;
    own.gravity = options.gravity;
    own.play = options.play;
    return sim::with_drive_errors(sim::make_mujoco_plant(drawn, built, own), drawn, built);
  }
  throw InputError(fmt::format("--engine '{}' is not known (known: {})", options.engine,
                               fmt::join(session_engines(), " ")));
}

/// Growth by warming as events of the port, straight from step to step.
std::vector<sim::FaultEvent> warming_events(const SessionOptions& options, int axes) {
  std::vector<sim::FaultEvent> events;
  if (options.growth == 0) return events;
  if (!(options.warming_time > 0)) throw InputError("a session that warms needs a time of warming above 0");
  const double step = kWarmingConstants * options.warming_time / kWarmingSteps;
  const auto grown = [&](int k) { return options.growth * (1 - std::exp(-k * step / options.warming_time)); };
  for (int k = 0; k < kWarmingSteps; ++k)
    for (int axis = 0; axis < axes; ++axis) {
      sim::FaultEvent event{.kind = sim::FaultKind::thermal_growth, .axis = axis, .time = k * step};
      event.duration = step;
      event.amount = grown(k + 1) - grown(k);
      events.push_back(event);
    }
  return events;
}

/// [s] that visits of these stops take, from home.
double planned_time(const machine::MachineDescription& machine,
                    const std::vector<std::vector<double>>& stops) {
  const auto mechanism = machine.make_mechanism();
  std::vector<double> at = home_axes(machine, *mechanism);
  double time = 0;
  for (const std::vector<double>& stop : stops) {
    const std::vector<double> first = beyond(*mechanism, stop, StopSide::lengthening);
    time += move_time(*mechanism, at, first) + move_time(*mechanism, first, stop) + kRestCheck;
    at = stop;
  }
  return time;
}

/// Poses that lie close together.
Pose middle(const std::vector<Pose>& poses) {
  Vec3 p = Vec3::Zero(), turn = Vec3::Zero();
  const Mat3 reference = poses.front().linear();
  for (const Pose& pose : poses) {
    p += pose.translation();
    turn += log_rotation(pose.linear() * reference.transpose());
  }
  const auto count = static_cast<double>(poses.size());
  return make_pose(Mat3(exp_rotation(turn / count) * reference), p / count);
}

}  // namespace

const std::vector<std::string>& session_engines() {
  static const std::vector<std::string> names{"quasistatic", "mujoco"};
  return names;
}

PlantSession::PlantSession(const machine::MachineDescription& drawn, const sim::AsBuilt& built,
                           const SessionOptions& options)
    : drawn_(drawn),
      options_(options),
      mechanism_(drawn.make_mechanism()),
      plant_(make_plant(drawn, built, options)),
      at_(home_axes(drawn, *mechanism_)) {
  sim::TwinOptions twin;
  twin.quantise_steps = options.microsteps;
  twin.faults = warming_events(options, mechanism_->axis_count());
  port_ = std::make_unique<sim::SimulatedPort>(drawn_, *plant_, sim::Exposure{},
                                               std::vector<sim::Observer*>{}, twin);
}

PlantSession::~PlantSession() = default;

double PlantSession::now() const { return port_->now(); }

void PlantSession::drive_to(const std::vector<double>& axes) {
  const double time = move_time(*mechanism_, at_, axes), start = port_->now();
  const int count = static_cast<int>(std::ceil(time / kPeriod));
  std::vector<Setpoint> setpoints;
  for (int k = 1; k <= count; ++k) {
    const double u = static_cast<double>(k) / count;
    const Smooth along(u);
    Setpoint setpoint;
    setpoint.time = start + u * time;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      setpoint.position[i] = at_[i] + along.place * (axes[i] - at_[i]);
      setpoint.velocity[i] = along.rate * (axes[i] - at_[i]) / time;
    }
    setpoints.push_back(setpoint);
  }
  if (const machine::Status s = port_->submit(setpoints, start + time); s != machine::Status::ok)
    throw InputError(fmt::format("{}: axes that cannot be driven to: {}", drawn_.name, to_string(s)));
  if (port_->wait_until(start + time) != machine::Status::ok)
    throw MachineError(fmt::format("{}: {}", plant_->engine(), port_->engine_failure()));
  at_ = axes;
}

Pose PlantSession::rest() {
  const double limit = port_->now() + kRestLimit;
  Pose before = plant_->tool_pose();
  double moved = 0;
  std::vector<Pose> last;
  while (port_->now() < limit) {
    if (port_->wait_until(port_->now() + kRestCheck) != machine::Status::ok)
      throw MachineError(fmt::format("{}: {}", plant_->engine(), port_->engine_failure()));
    const Pose now = plant_->tool_pose();
    // What warming moves meanwhile is no motion to wait for.
    const double warmed =
        options_.growth == 0 ? 0 : std::abs(options_.growth) * kRestCheck / options_.warming_time;
    const double still = kStill + 10 * warmed;
    moved = (now.translation() - before.translation()).norm();
    if (moved < still && angle_between(now.linear(), before.linear()) < kTurnStill + still / kTargetsLever)
      return now;
    before = now;
    if (port_->now() > limit - kSwingChecks * kRestCheck) last.push_back(now);
  }
  if (moved < kSwing) return middle(last);
  throw MachineError(
      fmt::format("{}: the tool does not come to rest within {} s: it moves by {:.1f} um in {} s",
                  plant_->engine(), kRestLimit, to_um(moved), kRestCheck));
}

Pose PlantSession::visit(const std::vector<double>& axes) {
  drive_to(beyond(*mechanism_, axes, options_.side));
  drive_to(axes);
  return rest();
}

void set_warming(const machine::MachineDescription& machine, double rise,
                 const std::vector<std::vector<double>>& stops, SessionOptions& options) {
  options.growth = strut_growth(machine, rise);
  options.warming_time = planned_time(machine, stops) / kSessionTimeConstants;
}

}  // namespace understudy::studies
