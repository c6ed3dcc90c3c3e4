// Our hexapod kinematics beside LinuxCNC's genhexkins, in one run: machine G4, the same poses, on one core
// but for the batch. The peer knows no deviation of the screw, so ours has none here either (it costs
// nothing).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bench/guarded.h"
#include "bench/kinematics/linuxcnc_genhexkins.h"
#include "kinematics/hexapod/hexapod_batch.h"
#include "kinematics/hexapod/hexapod_global_forward.h"
#include "tests/kinematics/workspace/workspace_pose.h"

namespace understudy::bench {
namespace {

using namespace kinematics;

constexpr int kPoses = 4096;
constexpr int kRounds = 21;  // odd; the median of these is told

/// Where the peer is not installed: measured with linuxcnc-uspace of Debian 12 on two cores,
/// 2026-11-21.
constexpr double kPeerInverse = 177, kPeerForward = 9'500;  // [ns], medians
constexpr int kPeerRefused = 674, kPeerElsewhere = 117;     // of 4096 far guesses, in the reference's own set

struct Case {
  Pose X, X_near, X_far;
  StrutLengths lengths{};
  Genhexkins::World world, world_near, world_far;
  double lengths_mm[kStruts] = {};
};

std::vector<Case> make_cases(const HexapodGeometry& g) {
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  Random random(1, "hexapod versus linuxcnc");
  std::vector<Case> cases(kPoses);
  for (Case& c : cases) {
    c.X = workspace_pose(g, joints, random, from_deg(15));
    c.X_near = nearby(c.X, from_mm(1), from_deg(1), random);
    c.X_far = nearby(c.X, from_mm(100), from_deg(30), random);
    if (inverse(g, c.X, c.lengths) != SolveStatus::ok)
      throw std::logic_error("a pose of the workspace has no struts");
    for (std::size_t i = 0; i < kStruts; ++i) c.lengths_mm[i] = to_mm(c.lengths[i]);
    c.world = Genhexkins::world_of(c.X);
    c.world_near = Genhexkins::world_of(c.X_near);
    c.world_far = Genhexkins::world_of(c.X_far);
  }
  return cases;
}

/// Nanoseconds per pose, each contender in turn within every round, so that both see the same machine.
std::vector<double> medians(const std::vector<std::function<void()>>& contenders) {
  std::vector<std::vector<double>> times(contenders.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      const auto start = std::chrono::steady_clock::now();
      contenders[k]();
      const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
      times[k].push_back(taken.count() / kPoses);
    }
  }
  std::vector<double> result;
  for (auto& t : times) {
    std::nth_element(t.begin(), t.begin() + kRounds / 2, t.end());
    result.push_back(t[kRounds / 2]);
  }
  return result;
}

struct Counts {
  int right = 0, elsewhere = 0, refused = 0;
  void add(bool found, const Pose& X_found, const Pose& X) {
    const bool there = found && (X_found.translation() - X.translation()).norm() < 1e-6 &&
                       angle_between(X_found.linear(), X.linear()) < 1e-5;
    ++(there ? right : found ? elsewhere : refused);
  }
};

void print(const char* what, double ours, double peer, bool measured, double goal) {
  std::printf("%-28s ours %8.1f ns   genhexkins %8.1f ns%s   ratio %5.1f (goal %.0f)\n", what, ours, peer,
              measured ? "" : " (2026-11-21)", peer / ours, goal);
}

void compare_speed(const HexapodGeometry& g, const std::vector<Case>& cases, const Genhexkins* peer,
                   double& sink) {
  const auto ours_inverse = [&] {
    for (const Case& c : cases) {
      StrutLengths lengths;
      sink += inverse(g, c.X, lengths) == SolveStatus::ok;
      sink += lengths[0] + lengths[5];
    }
  };
  const auto peer_inverse = [&] {
    for (const Case& c : cases) {
      double lengths[9] = {};
      if (peer != nullptr) peer->inverse(c.world, lengths);
      sink += lengths[0] + lengths[5];
    }
  };
  const auto ours_forward = [&] {
    for (const Case& c : cases) sink += forward(g, c.lengths, c.X_near).X_BT(0, 3);
  };
  const auto peer_forward = [&] {
    for (const Case& c : cases) {
      Genhexkins::World world = c.world_near;
      if (peer != nullptr) peer->forward(c.lengths_mm, world);
      sink += world.x;
    }
  };
  const std::vector<double> t = medians({ours_inverse, peer_inverse, ours_forward, peer_forward});
  const bool measured = peer != nullptr;
  print("inverse", t[0], measured ? t[1] : kPeerInverse, measured, 3);
  print("forward, 1 mm and 1 deg off", t[2], measured ? t[3] : kPeerForward, measured, 10);
}

void compare_accuracy(const HexapodGeometry& g, const std::vector<Case>& cases, const Genhexkins* peer) {
  double ours = 0, theirs = 0;
  int unsolved = 0;  // of the near guesses, by the peer
  Counts plain, far, peer_far;
  for (const Case& c : cases) {
    ours = std::max(ours, (forward(g, c.lengths, c.X_near).X_BT.translation() - c.X.translation()).norm());
    const ForwardResult from_seed = forward(g, c.lengths, c.X_far);
    plain.add(from_seed.status == SolveStatus::ok, from_seed.X_BT, c.X);
    const ForwardResult from_far = forward_global(g, c.lengths, c.X_far, Pose::Identity());
    far.add(from_far.status == SolveStatus::ok, from_far.X_BT, c.X);
    if (peer == nullptr) continue;
    Genhexkins::World world = c.world_near;
    unsolved += peer->forward(c.lengths_mm, world) != 0;
    theirs = std::max(theirs, (Genhexkins::pose_of(world).translation() - c.X.translation()).norm());
    world = c.world_far;
    const bool found = peer->forward(c.lengths_mm, world) == 0;
    peer_far.add(found, Genhexkins::pose_of(world), c.X);
  }
  std::printf("\nlargest error of the tip, 1 mm and 1 deg off: ours %.1e m", ours);
  if (peer != nullptr) std::printf(", genhexkins %.1e m (%d not solved)", theirs, unsolved);
  std::printf("\n\n%d starting guesses 100 mm and 30 deg off    right  elsewhere  refused\n", kPoses);
  const auto row = [](const char* name, const Counts& n) {
    std::printf("  %-42s %6d %10d %8d\n", name, n.right, n.elsewhere, n.refused);
  };
  row("ours, seed and home (forward_global)", far);
  row("ours, seed alone (forward)", plain);
  if (peer != nullptr)
    row("genhexkins", peer_far);
  else
    row("genhexkins (reference's own set)",
        {kPoses - kPeerRefused - kPeerElsewhere, kPeerElsewhere, kPeerRefused});
}

void show_batch(const HexapodGeometry& g, const std::vector<Case>& cases, double& sink) {
  std::vector<Pose> poses, seeds;
  constexpr std::size_t kTimes = 32;  // over: a batch worth its threads
  const std::size_t count = kTimes * cases.size();
  std::vector<StrutLengths> lengths, found(count);
  std::vector<SolveStatus> status(count);
  std::vector<ForwardResult> results(count);
  for (std::size_t n = 0; n < count; ++n) {
    const Case& c = cases[n % cases.size()];
    poses.push_back(c.X);
    seeds.push_back(c.X_near);
    lengths.push_back(c.lengths);
  }
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::function<void()>> contenders;
  for (const int threads : {1, cores}) {
    contenders.push_back([&, threads] { inverse_batch(g, poses, found, status, threads); });
    contenders.push_back([&, threads] { forward_batch(g, lengths, seeds, results, {}, threads); });
  }
  const std::vector<double> t = medians(contenders);
  std::printf("\nbatch of %zu poses     1 thread   %d threads\n", count, cores);
  std::printf("  inverse            %8.1f ns  %8.1f ns a pose\n", t[0] / kTimes, t[2] / kTimes);
  std::printf("  forward            %8.1f ns  %8.1f ns a pose\n", t[1] / kTimes, t[3] / kTimes);
  sink += found[0][0] + results[0].residual;
}

int run() {
  const HexapodGeometry g = nominal_g4(0);
  const std::vector<Case> cases = make_cases(g);
  std::string reason;
  const auto peer = Genhexkins::load(g, reason);
  if (peer == nullptr)
    std::printf("genhexkins is not here (%s): its figures are those of 2026-11-21.\n\n", reason.c_str());
  double sink = 0;
  compare_speed(g, cases, peer.get(), sink);
  show_batch(g, cases, sink);
  compare_accuracy(g, cases, peer.get());
  if (sink == 0.125) std::printf("\n");  // keeps the work from being optimised away
  return 0;
}

}  // namespace
}  // namespace understudy::bench

int main() { return understudy::bench::guarded("hexapod_versus_linuxcnc", understudy::bench::run); }
