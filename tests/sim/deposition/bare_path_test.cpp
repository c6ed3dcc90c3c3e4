// The path before a stretch on which the drive feeds and no bead comes to lie.
#include <gtest/gtest.h>

#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

// 1 mm was drawn back, 2 mm are fed over 10 mm of path: nothing comes out over the first 5 mm.
TEST(BarePath, IsWhereTheNozzleIsPrimed) {
  const auto stretch = [](double z, int parts) {
    Laying observer(printer());
    observer.observe(at(0, Vec3(1e-3, 0, z), 0));
    observer.observe(at(1, Vec3(0, 0, z), -1e-3));
    observer.run(parts, [&](double t) { return at(1 + t, Vec3(t * 10e-3, 0, z), (2 * t - 1) * 1e-3, 7); });
    const auto& all = observer.unsupported_stretches();
    return all.empty() ? UnsupportedStretch{} : all[0];
  };
  for (const int parts : {1, 3, 40}) {
    const UnsupportedStretch high = stretch(0.3e-3, parts);
    EXPECT_NEAR(high.bare_before.length, 5e-3, 1e-12) << parts;
    EXPECT_LE((high.bare_before.from_W - Vec3(0, 0, 0.3e-3)).norm(), 1e-12) << parts;
    EXPECT_EQ(high.bare_before.line, 7);
    EXPECT_NEAR(high.length, 5e-3, 1e-12) << parts;
  }
  EXPECT_EQ(stretch(0.15e-3, 3).length, 0) << "in the band";
}

TEST(BarePath, IsNoneInTheBand) {
  Laying observer(printer());
  observer.observe(at(0, Vec3(0, 0, 0.15e-3), 0));
  observer.observe(at(1, Vec3(0, 0, 0.15e-3), -0.1e-3));
  observer.observe(at(2, Vec3(2e-3, 0, 0.15e-3), -0.02e-3));  // fed in the band
  observer.observe(at(3, Vec3(3e-3, 0, 0.15e-3), -0.02e-3));  // and not on
  observer.observe(at(3, Vec3(3e-3, 0, 0.3e-3), -0.02e-3));
  observer.observe(at(4, Vec3(4e-3, 0, 0.3e-3), 0.02e-3));
  const auto& stretches = observer.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_NEAR(stretches[0].bare_before.length, 0.5e-3, 1e-12);
}

// The drive starts: what comes out over the first 0.1 mm falls as a drop, and the strand goes on from there.
TEST(BarePath, IsThatOfTheDropInWhichAStretchBegins) {
  Laying observer(printer());
  observer.observe(at(0, Vec3(0, 0, 0.3e-3), 0));
  observer.observe(at(1, Vec3(0.1e-3, 0, 0.3e-3), 0.01e-3, 7));
  observer.run(
      50, [](double t) { return at(1 + t, Vec3(0.1e-3 + t * 2e-3, 0, 0.3e-3), 0.01e-3 + t * 0.05e-3, 8); });
  const auto& stretches = observer.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_NEAR(stretches[0].bare_before.length + stretches[0].length, 2.1e-3, 1e-12);
  EXPECT_NEAR(stretches[0].bare_before.length, 0.1e-3, 1e-12);
  EXPECT_EQ(stretches[0].bare_before.line, 7);
}

}  // namespace
}  // namespace understudy::sim
