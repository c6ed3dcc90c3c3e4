// Nanoseconds per pose on machine G4: inverse, Jacobian, forward from home and from a neighbouring pose.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/random_vector.h"
#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {
namespace {

struct Case {
  Pose X;
  Pose X_neighbour;  // 1 mm and 1 degree away
  StrutLengths lengths{};
};

const HexapodGeometry& machine() {
  static const HexapodGeometry geometry = nominal_g4(0.015);
  return geometry;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> made;
    const HexapodJoints joints = joints_at_home(machine(), Pose::Identity());
    Random random(1, "bench");
    const auto direction = [&] { return normal_vec3(random).normalized(); };
    while (made.size() < 1024) {
      Case c;
      const Vec3 p = uniform_vec3(random, 0.05);
      c.X = tilted(p, random.uniform(0, from_deg(15)), random.uniform(0, 2 * std::numbers::pi));
      if (!within_limits(machine(), joints, limits_g4(), c.X)) continue;
      c.X_neighbour = make_pose(Mat3(exp_rotation(from_deg(1) * direction()) * c.X.linear()),
                                c.X.translation() + 1e-3 * direction());
      if (inverse(machine(), c.X, c.lengths) != SolveStatus::ok) continue;
      made.push_back(c);
    }
    return made;
  }();
  return all;
}

template <typename Work>
void over_cases(benchmark::State& state, Work work) {
  const auto& all = cases();
  std::size_t n = 0;
  for (auto _ : state) {
    work(all[n]);
    n = (n + 1) % all.size();
  }
  state.SetItemsProcessed(state.iterations());
}

void inverse_kinematics(benchmark::State& state) {
  over_cases(state, [](const Case& c) {
    StrutLengths lengths;
    benchmark::DoNotOptimize(inverse(machine(), c.X, lengths));
    benchmark::DoNotOptimize(lengths);
  });
}

void jacobian_of_lengths(benchmark::State& state) {
  over_cases(state, [](const Case& c) {
    Mat6 J;
    benchmark::DoNotOptimize(jacobian(machine(), c.X, J));
    benchmark::DoNotOptimize(J);
  });
}

void forward_from_home(benchmark::State& state) {
  over_cases(state, [](const Case& c) {
    benchmark::DoNotOptimize(forward(machine(), c.lengths, Pose::Identity()));
  });
}

void forward_warm(benchmark::State& state) {
  over_cases(state,
             [](const Case& c) { benchmark::DoNotOptimize(forward(machine(), c.lengths, c.X_neighbour)); });
}

void check_all_limits(benchmark::State& state) {
  const HexapodJoints joints = joints_at_home(machine(), Pose::Identity());
  const HexapodLimits limits = limits_g4();
  std::vector<LimitViolation> violations;
  over_cases(state, [&](const Case& c) {
    violations.clear();
    check(machine(), joints, limits, c.X, violations);
    benchmark::DoNotOptimize(violations.size());
  });
}

BENCHMARK(inverse_kinematics);
BENCHMARK(jacobian_of_lengths);
BENCHMARK(forward_from_home);
BENCHMARK(forward_warm);
BENCHMARK(check_all_limits);

}  // namespace
}  // namespace understudy::kinematics

BENCHMARK_MAIN();
