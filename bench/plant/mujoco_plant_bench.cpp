// Real-time factor of the MuJoCo plant, and its loop against raw mj_step of the very same model. Both run the
// same circle in turns of a few milliseconds, so that what else the computer does strikes both alike.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "bench/guarded.h"
#include "machine/description.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_engine.h"
#include "sim/plant/plant.h"

namespace understudy::sim {
namespace {

constexpr double kLeastRealTimeFactor = 10;
constexpr double kMostOverhead = 1.15;  // our loop over raw mj_step
constexpr int kTurn = 100;              // steps that one side runs before the other
constexpr int kTurns = 200;

/// Of this thread: other programs lengthen it only by the cache that they take.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A level circle of 10 mm radius in 2 s about home: within reach, and with loads on every strut.
std::vector<DriveCommand> circle_commands(const machine::MachineDescription& machine, double timestep,
                                          int count) {
  std::vector<DriveCommand> commands(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double rate = std::numbers::pi, angle = rate * k * timestep, radius = 0.01;
    Pose X_BT = machine.X_BT_home;
    X_BT.translation() += radius * Vec3(std::cos(angle) - 1, std::sin(angle), 0);
    Twist twist = Twist::Zero();
    twist.head<3>() = radius * rate * Vec3(-std::sin(angle), std::cos(angle), 0);
    kinematics::StrutLengths lengths{};
    Mat6 J;
    if (kinematics::inverse(machine.hexapod().geometry, X_BT, lengths) != kinematics::SolveStatus::ok ||
        kinematics::jacobian(machine.hexapod().geometry, X_BT, J) != kinematics::SolveStatus::ok)
      throw std::runtime_error("the circle leaves the workspace");
    const Twist rates = J * twist;
    auto& command = commands[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
      command.position[i] = lengths[i] - machine.hexapod().geometry.length_offset[i];
      command.velocity[i] = rates(static_cast<Eigen::Index>(i));
    }
  }
  return commands;
}

/// The engine alone: drive targets and mj_step.
class RawLoop {
 public:
  RawLoop(const machine::MachineDescription& machine, const AsBuilt& built, const MujocoOptions& options,
          const DriveCommand& start)
      : model_(load_model(write_mjcf(machine, built, machine.X_WB * machine.X_BT_home, options))),
        data_(make_data(*model_)),
        start_(start),
        lead_(2 * kConstraintSteps * options.timestep * kImpedance) {
    for (int i = 0; i < kinematics::kStruts; ++i)
      drives_.push_back(find_id(*model_, mjOBJ_EQUALITY, strut_part(i, kScrewPart)));
  }
  void step(const DriveCommand& command) {
    for (std::size_t i = 0; i < kinematics::kStruts; ++i)
      model_->eq_data[mjNEQDATA * static_cast<std::ptrdiff_t>(drives_[i])] =
          command.position[i] - start_.position[i] + lead_ * command.velocity[i];
    mj_step(model_.get(), data_.get());
    iterations_ += data_->solver_iter;
    rows_ += data_->nefc;
  }
  Vec3 tip() const { return Eigen::Map<const Vec3>(data_->qpos); }
  const mjModel& model() const { return *model_; }
  double iterations() const { return iterations_; }
  double rows() const { return rows_; }

 private:
  ModelPointer model_;
  DataPointer data_;
  DriveCommand start_;
  double lead_;
  std::vector<int> drives_;
  double iterations_ = 0, rows_ = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Timing {
  double real_time_factor = 0, overhead = 0;
};

Timing measure(const char* name, const machine::MachineDescription& machine, const MujocoOptions& options) {
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto commands = circle_commands(machine, options.timestep, kTurn * kTurns);
  const auto plant = make_mujoco_plant(machine, built, options);
  RawLoop raw(machine, built, options, commands.front());
  // The plant has settled when it is made; let the engine settle alike.
  DriveCommand hold = commands.front();
  hold.velocity.fill(0);
  const int settling = static_cast<int>(std::ceil(0.2 / options.timestep));
  for (int step = 0; step < settling; ++step) raw.step(hold);

  std::vector<double> ours, engine, ratio;
  double watched = 0;  // what observers read; keeps the compiler from dropping the reads
  for (std::size_t turn = 0; turn < kTurns; ++turn) {
    const auto begin = commands.begin() + static_cast<std::ptrdiff_t>(turn * kTurn), end = begin + kTurn;
    const double t0 = cpu_seconds();
    for (auto command = begin; command != end; ++command) {
      plant->step(*command);
      watched += plant->tool_pose().translation().x() + plant->displacement()[0] + plant->closure_error();
    }
    const double t1 = cpu_seconds();
    for (auto command = begin; command != end; ++command) raw.step(*command);
    const double t2 = cpu_seconds();
    ours.push_back((t1 - t0) / kTurn);
    engine.push_back((t2 - t1) / kTurn);
    ratio.push_back((t1 - t0) / (t2 - t1));
  }
  if (!std::isfinite(watched) || (plant->tool_pose().translation() - raw.tip()).norm() > 1e-6)
    throw std::runtime_error("the two loops did not run the same motion");

  const double steps = kTurn * kTurns;
  const Timing timing{options.timestep / median(ours), median(ratio)};
  fmt::print("{:<22} {:>5} {:>6.1f} {:>6.2f} {:>10.1f} {:>10.1f} {:>8.3f} {:>8.1f}\n", name, raw.model().nv,
             raw.rows() / steps, raw.iterations() / steps, 1e6 * median(ours), 1e6 * median(engine),
             timing.overhead, timing.real_time_factor);
  return timing;
}

int run() {
  const auto machine = machine::load_machine("hexapod");
  MujocoOptions rigid, play, all_ways;
  rigid.play = false;
  all_ways.play_across_struts = true;
  fmt::print("{:<22} {:>5} {:>6} {:>6} {:>10} {:>10} {:>8} {:>8}\n", "model", "dof", "rows", "iter",
             "ours us", "engine us", "ratio", "RTF");
  const Timing timings[] = {measure("without play", machine, rigid), measure("with play", machine, play)};
  measure("with play, ball 3D", machine, all_ways);
  fmt::print(
      "limits: ratio <= {}, RTF >= {} at {} ms (medians of CPU time; the last row is for information)\n",
      kMostOverhead, kLeastRealTimeFactor, 1e3 * play.timestep);
  for (const Timing& timing : timings)
    if (timing.overhead > kMostOverhead || timing.real_time_factor < kLeastRealTimeFactor) return 1;
  return 0;
}

}  // namespace
}  // namespace understudy::sim

int main() { return understudy::bench::guarded("mujoco_plant_bench", understudy::sim::run); }
