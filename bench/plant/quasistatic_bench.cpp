// Path samples a second of the quasistatic plant and sampler of the shipped hexapod with play, on one core,
// against its forward kinematics alone on the same path. All run in turns, so that what else the computer
// does strikes all alike.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "bench/guarded.h"
#include "machine/description.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::sim {
namespace {

constexpr double kLeastSampled = 200e3, kLeastStepped = 300e3;  // [1/s]
constexpr int kTurns = 60;
constexpr double kTimestep = 2e-3;  // [s]
constexpr int kSamples = 1500;      // 3 s: two turns of the circle a second

using kinematics::kStruts;

/// Of this thread.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A circle of 15 mm at 15 degrees of tilt, fast enough to turn the loads of struts.
std::vector<PathSample> circle_path(const machine::MachineDescription& machine) {
  const auto& geometry = machine.hexapod().geometry;
  std::vector<PathSample> path(kSamples);
  for (int k = 0; k < kSamples; ++k) {
    const double rate = 4 * std::numbers::pi, angle = rate * k * kTimestep, radius = 0.015;
    Pose X_BT = machine.X_BT_home;
    X_BT.linear() = exp_rotation(Vec3(15 * std::numbers::pi / 180, 0, 0));
    X_BT.translation() += radius * Vec3(std::cos(angle), std::sin(angle), 0);
    Twist twist = Twist::Zero();
    twist.head<3>() = radius * rate * Vec3(-std::sin(angle), std::cos(angle), 0);
    kinematics::StrutLengths lengths{};
    Mat6 J;
    if (kinematics::inverse(geometry, X_BT, lengths) != kinematics::SolveStatus::ok ||
        kinematics::jacobian(geometry, X_BT, J) != kinematics::SolveStatus::ok)
      throw std::runtime_error("the circle leaves the workspace");
    const Twist rates = J * twist;
    auto& sample = path[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < kStruts; ++i) {
      sample.position[i] = lengths[i] - geometry.length_offset[i];
      sample.velocity[i] = rates(static_cast<Eigen::Index>(i));
    }
  }
  // Whole turns: the last sample comes before the first.
  for (std::size_t k = 0; k < path.size(); ++k) {
    const PathSample& next = path[(k + 1) % path.size()];
    const PathSample& last = path[(k + path.size() - 1) % path.size()];
    for (std::size_t i = 0; i < kStruts; ++i)
      path[k].acceleration[i] = (next.velocity[i] - last.velocity[i]) / (2 * kTimestep);
  }
  return path;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Seconds a sample of one turn, for every turn.
template <typename Work>
void time_turn(std::vector<double>& seconds, Work work) {
  const double begin = cpu_seconds();
  work();
  seconds.push_back((cpu_seconds() - begin) / kSamples);
}

/// How often a drive's load turns its sign along the path: without that the plays would have nothing to do.
int count_reversals(QuasistaticSampler& sampler, const std::vector<PathSample>& path) {
  int reversals = 0;
  kinematics::AxisVector before{};
  for (const PathSample& sample : path) {
    Pose X_WT;
    if (sampler.sample(sample, X_WT) != kinematics::SolveStatus::ok)
      throw std::logic_error("the path leaves the workspace");
    const kinematics::AxisVector gap = sampler.gap();
    for (std::size_t i = 0; i < kStruts; ++i) reversals += gap[i] * before[i] < 0 ? 1 : 0;
    before = gap;
  }
  return reversals;
}

int run() {
  const auto machine = machine::load_machine("hexapod");
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const std::vector<PathSample> path = circle_path(machine);
  QuasistaticSampler sampler(machine, built);
  const auto plant = make_quasistatic_plant(machine, built);
  const int reversals = count_reversals(sampler, path);

  std::vector<double> sampled, stepped, forward;
  std::vector<Pose> poses(path.size());
  DriveCommand command{path.front().position, path.front().velocity};
  plant->reset(command.position);
  double watched = 0;  // keeps the compiler from dropping what is timed
  kinematics::ForwardResult warm;
  warm.X_BT = machine.X_BT_home;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::size_t ok = 0;
    time_turn(sampled, [&] { ok = sampler.sample(path, poses); });
    if (ok != path.size()) throw std::runtime_error("a sample has no pose");
    time_turn(stepped, [&] {
      for (const PathSample& sample : path) {
        command = {sample.position, sample.velocity};
        plant->step(command);
        watched += plant->tool_pose().translation().x();
      }
    });
    time_turn(forward, [&] {
      for (const PathSample& sample : path) {
        kinematics::StrutLengths lengths;
        for (std::size_t i = 0; i < kStruts; ++i)
          lengths[i] = sample.position[i] + built.hexapod.length_offset[i];
        warm = kinematics::forward(built.hexapod, lengths, warm.X_BT);
        watched += warm.X_BT.translation().x();
      }
    });
    if (warm.status != kinematics::SolveStatus::ok) throw std::runtime_error("a pose was not found");
  }
  if (!std::isfinite(watched)) throw std::runtime_error("the plant left the path");

  const double raw = median(forward);
  fmt::print("shipped hexapod, {:.0f} um of play a strut, {} samples a turn with {} load reversals\n",
             1e6 * (built.nut_play[0] + built.ball_play[0]), kSamples, reversals);
  fmt::print("{:<28} {:>14} {:>10} {:>22}\n", "", "samples/s", "us", "x forward kinematics");
  const auto row = [&](const char* name, double seconds) {
    fmt::print("{:<28} {:>14.0f} {:>10.3f} {:>22.2f}\n", name, 1 / seconds, 1e6 * seconds, seconds / raw);
  };
  row("sampler", median(sampled));
  row("plant, one step a sample", median(stepped));
  row("forward kinematics alone", raw);
  fmt::print("limits: sampler >= {:.0f}, plant >= {:.0f} samples/s\n", kLeastSampled, kLeastStepped);
  return median(sampled) * kLeastSampled <= 1 && median(stepped) * kLeastStepped <= 1 ? 0 : 1;
}

}  // namespace
}  // namespace understudy::sim

int main() { return understudy::bench::guarded("quasistatic_bench", understudy::sim::run); }
