// A tool on three rods: the closed forms against the rods' lengths, and their rates against differences.
#include "kinematics/chain/rods.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::kinematics {
namespace {

constexpr double kRound = 1e-12;  // [m], of a machine half a metre high

/// Towers that lean, rods of three lengths, joints at three heights.
Chain crooked(Random& random) {
  Chain chain;
  for (int i = 0; i < kRods; ++i) {
    const double angle = from_deg(210 + 120 * i) + 0.1 * random.normal();
    ChainAxis axis =
        sliding_axis(std::string(1, "abc"[i]), (Vec3::UnitZ() + 0.05 * normal_vec3(random)).normalized(), -1);
    axis.point = 0.134 * Vec3(std::cos(angle), std::sin(angle), 0) + 0.005 * normal_vec3(random);
    chain.axes.push_back(axis);
    chain.rods.push_back(0.267 + 0.005 * random.normal());
  }
  return chain;
}

Vec3 random_place(Random& random) {
  return {random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), random.uniform(-0.1, 0.3)};
}

TEST(Rods, MeetBelowTheirSlidesAtTheLengthOfEach) {
  Random random(71, "rods");
  for (int n = 0; n < 2000; ++n) {
    const Chain chain = crooked(random);
    const Vec3 p = random_place(random);
    AxisVector slides{};
    ASSERT_EQ(slides_of_rods(chain, p, slides), SolveStatus::ok);
    for (std::size_t i = 0; i < kRods; ++i) {
      const Vec3 joint = chain.axes[i].point + slides[i] * chain.axes[i].direction;
      ASSERT_NEAR((p - joint).norm(), chain.rods[i], kRound);
      ASSERT_GT(joint.z(), p.z());
    }
    Vec3 found;
    ASSERT_EQ(rods_meet(chain, slides, found), SolveStatus::ok);
    ASSERT_LE((found - p).norm(), 1e-11) << n;  // a crossing of spheres at down to 20 degrees
  }
}

TEST(Rods, MoveTheToolAsDifferencesSay) {
  constexpr double h = 1e-5;  // h^2 times a third derivative of some 100 per m^2, and 1e-11 / h
  Random random(72, "rods");
  for (int n = 0; n < 200; ++n) {
    const Chain chain = crooked(random);
    const Vec3 p = random_place(random);
    AxisVector slides{};
    ASSERT_EQ(slides_of_rods(chain, p, slides), SolveStatus::ok);
    const Mat3 J = rod_jacobian(chain, rod_vectors(chain, slides, p));
    ChainJacobian by_chain;
    EXPECT_LE((forward(chain, slides, by_chain).translation() - p).norm(), 1e-11);
    EXPECT_LE((by_chain.topRows<3>() - J).norm(), 1e-12);
    EXPECT_EQ(by_chain.bottomRows<3>().norm(), 0);  // it only translates
    for (int i = 0; i < kRods; ++i) {
      const auto moved = [&](double by) {
        AxisVector at = slides;
        at[static_cast<std::size_t>(i)] += by;
        Vec3 found;
        EXPECT_EQ(rods_meet(chain, at, found), SolveStatus::ok);
        return found;
      };
      EXPECT_LE(((moved(h) - moved(-h)) / (2 * h) - J.col(i)).norm(), 1e-5) << n;
    }
  }
}

TEST(Rods, ThatCannotMeetSaySoAndStayFinite) {
  Random random(73, "rods");
  Chain chain = crooked(random);
  AxisVector slides{};
  Vec3 p;
  slides[2] = 0.7;  // farther above the others than two rods reach
  EXPECT_EQ(rods_meet(chain, slides, p), SolveStatus::unreachable);
  EXPECT_TRUE(p.allFinite());
  chain.axes[1].point = chain.axes[0].point;
  chain.axes[1].direction = chain.axes[0].direction;
  slides = {};
  EXPECT_EQ(rods_meet(chain, slides, p), SolveStatus::unreachable);
  EXPECT_TRUE(p.allFinite());
  EXPECT_TRUE(forward(chain, slides).matrix().allFinite());
  slides = {1, 2, 3};
  EXPECT_EQ(slides_of_rods(chain, Vec3(0.3, 0, 0), slides), SolveStatus::unreachable);
  EXPECT_EQ(slides, (AxisVector{1, 2, 3}));
}

TEST(Rods, TellTheirLeanAndWhatTheySpan) {
  Chain chain;
  for (int i = 0; i < kRods; ++i) {
    ChainAxis axis = sliding_axis("abc", Vec3::UnitZ(), -1);
    axis.point = {0.3 * std::cos(from_deg(120.0 * i)), 0.3 * std::sin(from_deg(120.0 * i)), 0};
    chain.axes.push_back(axis);
    chain.rods.push_back(0.5);
  }
  // 3, 4 and 5 over the middle.
  AxisVector slides{};
  ASSERT_EQ(slides_of_rods(chain, Vec3(0, 0, 0.1), slides), SolveStatus::ok);
  const Mat3 rods = rod_vectors(chain, slides, Vec3(0, 0, 0.1));
  for (int i = 0; i < kRods; ++i) {
    EXPECT_NEAR(slides[static_cast<std::size_t>(i)], 0.5, kRound);
    EXPECT_NEAR(rod_lean(chain, rods, i), std::atan2(3, 4), 1e-12);
    EXPECT_NEAR(rod_span(chain, Vec3(0, 0, 0.1), i), 0.3, kRound);
  }
  // Rods in one plane: no velocity of the slides is one of the tool.
  Mat3 flat = rods;
  flat.col(2).setZero();
  EXPECT_EQ(rod_jacobian(chain, flat), Mat3::Zero());
}

TEST(Rods, AllocateNothing) {
  Random random(74, "rods");
  const Chain chain = crooked(random);
  AxisVector slides{};
  Vec3 p(0.01, 0.02, 0.03);
  EXPECT_EQ(calls_of([&] {
              static_cast<void>(slides_of_rods(chain, p, slides));
              static_cast<void>(rods_meet(chain, slides, p));
              static_cast<void>(rod_jacobian(chain, rod_vectors(chain, slides, p)));
            }),
            Calls{});
}

}  // namespace
}  // namespace understudy::kinematics
