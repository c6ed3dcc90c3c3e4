// Something that shines and stands still in the picture while the tool moves: a thread of plastic on the
// nozzle, a crumb. It may flicker as speckle does. It must never lead the nozzle into the part.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "core/random_vector.h"
#include "tests/control/gap/bead_program.h"
#include "tests/control/gap/follower_loop.h"

namespace understudy::control {
namespace {

using testing::HasSubstr;

constexpr double kAim = 0.13e-3;    // [m]
constexpr double kSpeckle = 0.35;   // [px], 1 sigma (docs/reference.md#dot-and-gap: 0.30 to 0.46 px)
constexpr double kStandoff = 2e-3;  // [m]
constexpr double kLeft = 0.02e-3;   // [m]: half of the accepted minimum is kept by dead reckoning, less 4
                                    // sigma of the look from which it counts, at 5 um and 2 sigma of scale

struct Ghost {
  double below = 0;    ///< [m], height over S from which on it is seen
  double offset = 0;   ///< [m], what it reads less the true gap when it appears
  double flicker = 0;  ///< [px]
};

struct Led {
  GapOutcome outcome;
  double gap_min = 1;  ///< [m], true
};

/// An approach on a flat part during which a ghost takes the dot's place.
Led approach_a_ghost(const Ghost& ghost, double error, std::uint64_t seed) {
  GapRig rig(hexapod(), {flat_part(), Vec3(0, 0, error), Vec3::Zero(), kSpeckle, seed});
  RigMotion motion(hexapod(), rig);
  const Pose X_WT_S = make_pose(Quat::Identity(), Vec3(0, 0, kTable + kGap));
  Pose above = X_WT_S;
  above.translation().z() += kStandoff;
  EXPECT_EQ(motion.move_to(above), machine::Status::ok);
  const std::size_t begin = rig.port().history().size();
  std::optional<Vec2> at;
  Random random(seed, "ghost");
  rig.set_frame_fault([&](const Pose& X, Image& image) {
    if (!at && X.translation().z() > X_WT_S.translation().z() + ghost.below) return true;
    Pose seen = rig.truth(X);
    seen.translation().z() += ghost.offset;
    if (!at) at = exact_dot(hexapod(), flat_part(), seen);
    rig.draw_spot(*at + ghost.flicker * normal_vec2(random), 190, image);
    return true;
  });
  Led led{close_gap(hexapod(), {}, X_WT_S, kStandoff, motion, {}), 1};
  const auto& history = rig.port().history();
  for (std::size_t i = begin; i < history.size(); i += 5)
    led.gap_min = std::min(led.gap_min, rig.gap_at(rig.commanded(history[i].position)));
  led.gap_min = std::min(led.gap_min, rig.gap_now());
  return led;
}

void approach_ghosts(int first, int ghosts) {
  int stopped = 0;
  double closest = 1;
  for (int i = first; i < first + ghosts; ++i) {
    Random random(static_cast<std::uint64_t>(i), "ghosts of approaches");
    // Most where a ghost can do harm: near the part, reading a little more than there is.
    const double below = i % 4 == 0 ? random.uniform(0.4e-3, 2.5e-3) : random.uniform(0, 0.4e-3);
    const Ghost ghost{below, random.uniform(-0.05e-3, 0.2e-3), i % 2 ? kSpeckle : 0.013};
    const Led led = approach_a_ghost(ghost, random.uniform(-1e-3, 1e-3), static_cast<std::uint64_t>(i));
    EXPECT_GT(led.gap_min, kLeft) << "ghost " << i << " below " << ghost.below << " off by " << ghost.offset
                                  << " flickering " << ghost.flicker << ": " << led.outcome.why;
    closest = std::min(closest, led.gap_min);
    stopped += led.outcome.stop != GapStop::none;
  }
  EXPECT_GT(stopped, ghosts / 4);  // the draw is not toothless
  std::printf("%d ghosts in approaches: %d stopped, %.1f um were left at least\n", ghosts, stopped,
              1e6 * closest);
}

TEST(Ghost, NeverLeadsAnApproachIntoThePart) { approach_ghosts(0, 40); }
TEST(SlowGhost, NeverLeadsAnyOfTwoThousandApproachesIntoThePart) { approach_ghosts(0, 2000); }

TEST(Ghost, FromTheBeginningIsFoundOutWithinAQuarterOfAMillimetre) {
  for (const double flicker : {0.0, kSpeckle}) {
    const Led led = approach_a_ghost({1, 0, flicker}, 0, 3);
    EXPECT_STREQ(to_string(led.outcome.stop), "no progress") << led.outcome.why;
    EXPECT_GT(led.gap_min, kStandoff + kGap - 0.25e-3 - 1e-6);
  }
}

/// What the follower is led to by a ghost that reads `reading` from a second on; the machine's own error
/// changes by `rate` [m/s].
FollowerLoop follow_a_ghost(double reading, double rate, std::uint64_t seed) {
  constexpr double kNoise = 5e-6;  // [m], as of a frame with speckle
  FollowerLoop loop(
      gap_follower_options(hexapod()), [rate](double t, double) { return kAim + rate * t; }, kNoise, seed);
  loop.follower.start(0, 0, kAim, kNoise);
  loop.set_camera([reading](double t, double, double gap) -> FollowerLoop::Look {
    return {GapStop::none, t > 1 ? reading : gap};
  });
  loop.run(20);  // 100 mm of path
  return loop;
}

TEST(Ghost, NeverLeadsAPrintBelowTheFloor) {
  const GapFollowerOptions options = gap_follower_options(hexapod());
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    for (const double off : {-10e-6, 0.0, 6e-6, 15e-6, 30e-6, 45e-6})
      for (const double rate : {0.0, 40e-6}) {
        const FollowerLoop loop = follow_a_ghost(kAim + off, rate, seed);
        double lowest = 1;
        for (const auto& p : loop.points) lowest = std::min(lowest, p.gap);
        EXPECT_GT(lowest, options.floor) << "seed " << seed << ", off by " << off << ", rate " << rate;
      }
}

TEST(Ghost, ThatReadsTooMuchStopsThePrint) {
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    EXPECT_EQ(follow_a_ghost(kAim + 40e-6, 0, seed).follower.stop(), GapStop::no_progress) << "seed " << seed;
}

TEST(Ghost, InTheMicroscopeStopsThePrintAboveTheFloor) {
  GapRig rig(hexapod(), low_by(0));
  std::optional<Vec2> at;
  Random random(5, "ghost");
  rig.set_frame_fault([&](const Pose& X, Image& image) {
    if (X.translation().x() < 2e-3) return true;
    Pose seen = rig.truth(X);
    seen.translation().z() += 45e-6;
    if (!at) at = exact_dot(hexapod(), flat_part(), seen);
    rig.draw_spot(*at + kSpeckle * normal_vec2(random), 190, image);
    return true;
  });
  PrintOptions options;
  options.gap_control = GapControl::continuous;
  const PrintResult result = print(bead_program(), hexapod(), rig.port(), options);
  EXPECT_FALSE(result.completed);
  EXPECT_THAT(result.stop.why, HasSubstr("no progress: "));
  EXPECT_THAT(result.stop.why, HasSubstr("; retreated by 2.000 mm"));
  for (const auto& s : rig.port().history())
    if (s.line >= 6) {
      ASSERT_GT(rig.gap_at(rig.commanded(s.position)), 0.05e-3) << "at " << s.time;
    }
}

}  // namespace
}  // namespace understudy::control
