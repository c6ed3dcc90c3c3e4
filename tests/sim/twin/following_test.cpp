// A print whose gap is followed on the twin: an as-built machine, its rendered dot, and what is done when the
// dot is lost.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/print.h"
#include "sim/as_built/as_built.h"
#include "sim/sensors/microscope.h"
#include "sim/twin/simulated_port.h"
#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kTop = control::kTable;  // [m], the part's

std::shared_ptr<const geometry::Mesh> slab() {
  auto box = geometry::box(Vec3(-30e-3, -30e-3, kTop - 5e-3), Vec3(30e-3, 30e-3, kTop));
  return std::make_shared<geometry::Mesh>(std::move(box.vertices), std::move(box.triangles));
}

class Truth : public Observer {
 public:
  void observe(const Snapshot& s) override { seen.push_back(s); }
  /// True gap of a slab that lies level: along a tool axis that leans by some mrad 0.01 % more.
  static double gap(const Snapshot& s) { return s.X_WT.translation().z() - kTop; }
  std::vector<Snapshot> seen;
};

struct Print {
  control::PrintResult result;
  std::vector<Snapshot> seen;
};

/// `dark_from` [m]: from this x on the laser is off.
Print follow(Plant& plant, double dark_from = HUGE_VAL) {
  const auto part = slab();
  Microscope microscope(hexapod(), part, 1);
  const Exposure expose = [&](const Shot& shot) {
    Image image = microscope.expose(shot);
    if (shot.X_WT.translation().x() > dark_from)
      std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return image;
  };
  Truth truth;
  SimulatedPort port(hexapod(), plant, expose, {&truth});
  control::PrintOptions options;
  options.gap_control = control::GapControl::continuous;
  options.part = part.get();
  Print print;
  print.result = control::print(control::bead_program(), hexapod(), port, options);
  static_cast<void>(port.wait_until(port.now() + 0.05));  // what was commanded last takes force
  print.seen = std::move(truth.seen);
  return print;
}

TEST(FollowingOnTheTwin, RetreatsWhenTheDotIsLostWhilePrinting) {
  const auto plant = make_quasistatic_plant(hexapod(), make_as_built(hexapod(), "sampled", 7));
  const Print print = follow(*plant, 3e-3);
  EXPECT_FALSE(print.result.completed);
  ASSERT_TRUE(print.result.following);
  EXPECT_STREQ(to_string(print.result.stop.gap), "no dot");
  EXPECT_THAT(print.result.stop.why, AllOf(HasSubstr("no dot: "), HasSubstr("; retreated by 2.000 mm")));
  ASSERT_FALSE(print.seen.empty());
  double lowest = 1, farthest = 0;
  for (const Snapshot& s : print.seen) {
    if (s.line >= 6) lowest = std::min(lowest, Truth::gap(s));
    farthest = std::max(farthest, s.X_WT.translation().x());
  }
  // Blind for 0.5 s at 5 mm/s, with the slope of the last reading for a millimetre: within the floor.
  EXPECT_GT(lowest, 0.05e-3);
  // 3 mm, 2.5 mm of half a second, two frames and the queue of 40 ms; 5 mm/s brake within 0.1 mm.
  EXPECT_LT(farthest, 3e-3 + 2.5e-3 + 0.5e-3 + 0.3e-3);
  const Snapshot& end = print.seen.back();
  EXPECT_NEAR(Truth::gap(end), 2.13e-3, 0.06e-3);  // the retreat from about the aim
  EXPECT_EQ(end.nozzle_temperature, 0);
  const auto rested = print.seen[print.seen.size() - 10];
  EXPECT_LT((end.X_WT.translation() - rested.X_WT.translation()).norm(), 1e-6) << "it still moves";
}

TEST(SlowFollowingOnTheTwin, KeepsTheGapOnTheMujocoEngine) {
  const auto plant = make_mujoco_plant(hexapod(), make_as_built(hexapod(), "sampled", 7));
  const Print print = follow(*plant);
  ASSERT_TRUE(print.result.completed) << print.result.stop.why;
  int inside = 0, all = 0;
  double lowest = 1;
  double fed = 0;
  for (const Snapshot& s : print.seen) {
    if (s.line >= 5) lowest = std::min(lowest, Truth::gap(s));  // the tip of the home pose is on the slab
    if (s.filament > fed) {
      ++all;
      inside += Truth::gap(s) > 0.1e-3 && Truth::gap(s) < 0.2e-3;
    }
    fed = std::max(fed, s.filament);
  }
  EXPECT_GT(lowest, 0.05e-3);
  ASSERT_GT(all, 500);  // 2 s of bead, a snapshot in 2 ms
  EXPECT_GE(static_cast<double>(inside) / all, 0.99);
  EXPECT_GT(print.result.following->used, 0.8 * print.result.following->frames);
}

}  // namespace
}  // namespace understudy::sim
