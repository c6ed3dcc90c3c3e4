#include "studies/repeatability/repeatability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::studies {
namespace {

constexpr double kShare = 0.4;  // of an edge, from the cube's centre to a pose (ISO 9283, 6.8.4)

void check(const RepeatabilityOptions& options) {
  const auto within = [](const char* name, double value, double low, double high, const char* unit) {
    if (!(value >= low && value <= high))
      throw InputError(fmt::format("{} {:g}{} is outside {:g}..{:g}{}", name, value, unit, low, high, unit));
  };
  within("--edge", to_mm(options.edge), 1, 10'000, " mm");
  within("--lean", to_deg(options.lean), -180, 180, " deg");
  within("--cycles", options.cycles, 2, 10'000, "");
  within("--tests", options.tests, 1, 10'000, "");
  if (options.friction) within("--friction", *options.friction, 0, 1000, "");
}

/// The axes of the pose, within all limits.
sim::PathSample sample_at(const machine::MachineDescription& machine, const kinematics::Mechanism& mechanism,
                          const Pose& X_WT) {
  const Pose X_BT = machine.X_WB.inverse() * X_WT;
  sim::PathSample sample;
  const std::span<double> axes =
      std::span(sample.position).first(static_cast<std::size_t>(mechanism.axis_count()));
  const auto status = mechanism.inverse(X_BT, {}, axes);
  std::vector<kinematics::LimitViolation> violations;
  mechanism.check(
      X_BT, status == kinematics::SolveStatus::ok ? std::span<const double>(axes) : std::span<const double>(),
      violations);
  if (status == kinematics::SolveStatus::ok && violations.empty()) return sample;
  throw InputError(fmt::format(
      "{} does not reach ({:.1f}, {:.1f}, {:.1f}) mm of the cube{}: name another --centre, --edge or --lean",
      machine.name, to_mm(X_WT.translation().x()), to_mm(X_WT.translation().y()),
      to_mm(X_WT.translation().z()), violations.empty() ? "" : ", " + to_string(violations.front())));
}

double of_positions(const std::vector<Vec3>& attained) {
  const double n = static_cast<double>(attained.size());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : attained) centre += p / n;
  double mean = 0, squares = 0;
  for (const Vec3& p : attained) mean += (p - centre).norm() / n;
  for (const Vec3& p : attained) squares += std::pow((p - centre).norm() - mean, 2);
  return mean + 3 * std::sqrt(squares / (n - 1));
}

class Approaches {
 public:
  Approaches(const machine::MachineDescription& machine, const RepeatabilityOptions& options)
      : options_(options),
        built_(sim::make_as_built(machine, "nominal", options.seed)),
        sampler_(machine, built_),
        random_(options.seed, "approaches") {}

  /// Mean over the tests.
  double test(const sim::PathSample& pose, int axes) {
    double sum = 0;
    for (int test = 0; test < options_.tests; ++test) {
      stop_if_interrupted();
      std::vector<Vec3> attained;
      for (int cycle = 0; cycle < options_.cycles; ++cycle) attained.push_back(approach(pose, axes));
      sum += of_positions(attained);
    }
    return sum / options_.tests;
  }

 private:
  Vec3 approach(const sim::PathSample& pose, int axes) {
    for (int i = 0; i < axes; ++i) {
      const double half = built_.axis_play[static_cast<std::size_t>(i)] / 2;
      sampler_.place_gap(i, !options_.one_side && random_.uniform() < 0.5 ? half : -half);
    }
    Pose X_WT;
    if (sampler_.sample(pose, X_WT) != kinematics::SolveStatus::ok)
      throw MachineError("the built machine has no solution at a pose of the cube");
    return X_WT.translation();
  }

  const RepeatabilityOptions& options_;
  sim::AsBuilt built_;
  sim::QuasistaticSampler sampler_;
  Random random_;
};

}  // namespace

Repeatability repeatability(const machine::MachineDescription& described,
                            const RepeatabilityOptions& options) {
  check(options);
  machine::MachineDescription machine = described;
  if (!machine.is_chain())
    throw InputError(
        fmt::format("repeatability: {} is no chain of axes: name an arm or a printer of axes", machine.name));
  if (options.friction) machine.chain().friction.fill(*options.friction);
  const auto mechanism = machine.make_mechanism();
  const double h = kShare * options.edge;
  constexpr std::array<std::array<int, 3>, 5> kCorners{
      {{0, 0, 0}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, -1}, {1, -1, -1}}};
  std::vector<Pose> poses;
  std::vector<sim::PathSample> samples;
  for (const auto& corner : kCorners) {
    Pose X_WT = Pose::Identity();
    X_WT.translation() = options.centre + h * Vec3(corner[0], corner[1], corner[2]);
    X_WT.linear() = exp_rotation(Vec3(0, -options.lean, 0));
    samples.push_back(sample_at(machine, *mechanism, X_WT));
    poses.push_back(X_WT);
  }
  Repeatability result;
  result.machine = machine.name;
  result.options = options;
  Approaches approaches(machine, options);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double figure = approaches.test(samples[i], mechanism->axis_count());
    result.poses.push_back({poses[i].translation(), figure});
    result.mean += figure / static_cast<double>(poses.size());
    result.largest = std::max(result.largest, figure);
  }
  return result;
}

}  // namespace understudy::studies
