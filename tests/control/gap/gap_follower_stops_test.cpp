// What ends the following, and the reason that is given.
#include "control/gap/gap_follower.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "tests/control/gap/known_gap_loop.h"

namespace understudy::control {
namespace {

TEST(GapFollower, LostFramesAreWaitedForAndThenSaidToBeLost) {
  for (const auto& [seconds, stop] : {std::pair{0.3, GapStop::none}, {0.7, GapStop::port_failed}}) {
    auto loop = loop_with([](double t, double) { return kAim - 50e-6 * t; }, 4e-6);
    loop.set_camera([end = 1 + seconds](double t, double, double gap) -> FollowerLoop::Look {
      return {t > 1 && t < end ? GapStop::port_failed : GapStop::none, gap};
    });
    loop.run(3);
    EXPECT_EQ(loop.follower.stop(), stop) << seconds;
    for (const auto& p : loop.points) EXPECT_NEAR(p.gap, kAim, 25e-6) << seconds << " s lost, at " << p.time;
  }
}

TEST(GapFollower, SaysWhatItsLooksSuffered) {
  for (const GapStop reason : {GapStop::saturated, GapStop::no_dot, GapStop::stale_frame}) {
    auto loop = loop_with([](double, double) { return kAim; }, 4e-6);
    int n = 0;
    loop.set_camera([&](double t, double, double gap) -> FollowerLoop::Look {
      // One of five looks suffers from something else.
      return {t < 1 ? GapStop::none : (++n % 5 ? reason : GapStop::implausible), gap};
    });
    loop.run(3);
    EXPECT_EQ(loop.follower.stop(), reason);
  }
}

TEST(GapFollower, HalfOfTheFramesAreEnough) {
  auto loop = loop_with([](double t, double) { return kAim - 80e-6 * t; }, 5e-6);
  int n = 0;
  loop.set_camera([&](double, double, double gap) -> FollowerLoop::Look {
    return {++n % 2 ? GapStop::no_dot : GapStop::none, gap};
  });
  loop.run(3);
  EXPECT_EQ(loop.follower.stop(), GapStop::none);
  EXPECT_LT(rms_from(loop, 0.6, kAim), 8e-6);
}

TEST(GapFollower, APictureThatStandsStillIsStale) {
  auto loop = loop_with([](double, double) { return kAim; });
  loop.set_camera([](double, double, double) -> FollowerLoop::Look { return {GapStop::none, kAim + 7e-6}; });
  loop.run(3);
  EXPECT_EQ(loop.follower.stop(), GapStop::stale_frame);
  for (const auto& p : loop.points) EXPECT_GT(p.gap, 0.1e-3);
}

TEST(GapFollower, StopsBeforeTheNozzleTouches) {
  GapFollowerOptions options = options_of_hexapod();
  options.rate_max = 0.05e-3;  // slower than the surface comes
  auto loop = loop_with([](double t, double) { return kAim - 0.2e-3 * t; }, 4e-6, 1, options);
  loop.run(3);
  EXPECT_EQ(loop.follower.stop(), GapStop::too_close);
  EXPECT_GT(loop.points.back().gap, 0.02e-3);
}

TEST(GapFollower, StopsWhereTheSurfaceIsFartherOffThanItMayFollow) {
  auto loop = loop_with([](double t, double) { return kAim - 0.15e-3 * t; }, 4e-6);
  loop.run(6);
  EXPECT_EQ(loop.follower.stop(), GapStop::too_far);
  EXPECT_NEAR(loop.points.back().time, 0.5 / 0.15, 0.2);
  // It brakes from 0.15 mm/s at 20 mm/s^2: v^2 / 2a.
  for (const auto& p : loop.points) EXPECT_LE(std::abs(p.correction), 0.5e-3 + 1e-6);
}

TEST(GapFollower, ASpotThatLeadsTheToolAwayIsNoSurface) {
  int stopped = 0, seed = 0;
  for (double below = 10e-6; below < 60e-6; below += 10e-6)
    for (double from = 0.8; from < 2; from += 0.1) {  // [s], wherever an excitation is just then
      auto loop = loop_with([](double, double) { return kAim; }, 1.5e-6, static_cast<std::uint64_t>(++seed),
                            options_of_hexapod());
      loop.set_camera([&](double time, double, double gap) {
        return FollowerLoop::Look{GapStop::none, time < from ? gap : kAim - below};
      });
      loop.run(12);
      EXPECT_EQ(loop.follower.stop(), GapStop::no_progress) << below << ' ' << from;
      stopped += loop.follower.unanswered() > 0;
    }
  EXPECT_GT(stopped, 0);
}

// Four of five frames give nothing, and the surface sinks: what is left does not prove that it may be
// followed.
TEST(GapFollower, WhereFramesAreWantingTheirReasonIsTheOneThatIsSaid) {
  auto loop = loop_with([](double t, double) { return kAim + 0.1e-3 * t; }, 1.5e-6, 1, options_of_hexapod());
  int n = 0;
  loop.set_camera([&](double, double, double gap) {
    return FollowerLoop::Look{++n % 5 ? GapStop::saturated : GapStop::none, gap};
  });
  loop.run(12);
  EXPECT_EQ(loop.follower.stop(), GapStop::saturated);
  EXPECT_GT(loop.follower.prevented(), FrameOutcomes::kFrames / 2);
}

}  // namespace
}  // namespace understudy::control
