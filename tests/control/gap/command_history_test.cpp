#include "control/gap/command_history.h"

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::control {
namespace {

Commanded at_cycle(int k) {
  Commanded c;
  c.time = 1e-3 * k;
  c.path = 5e-3 * c.time;
  c.correction = -2e-3 * c.time;
  c.filament = 1e-4 * c.time;
  c.X_WT.translation().x() = 7e-3 * c.time;
  c.line = k;
  return c;
}

TEST(CommandHistory, RemembersNothingWhileItIsEmpty) {
  CommandHistory history(0.5, 1e-3);
  Commanded found;
  EXPECT_TRUE(history.empty());
  EXPECT_FALSE(history.at(0, found));
  history.push(at_cycle(1));
  EXPECT_TRUE(history.at(1e-3, found));
  history.clear();
  EXPECT_FALSE(history.at(1e-3, found));
}

TEST(CommandHistory, IsStraightBetweenTwoCycles) {
  CommandHistory history(0.5, 1e-3);
  Commanded a, b;
  a.time = 1, a.path = 10, a.correction = 2, a.filament = 0, a.line = 3;
  b.time = 2, b.path = 20, b.correction = 0, b.filament = 4, b.line = 4, b.printing = true;
  b.X_WT = make_pose(exp_rotation(Vec3(0, 0, from_deg(80))), Vec3(0, 8, 0));
  history.push(a);
  history.push(b);
  Commanded found;
  ASSERT_TRUE(history.at(1.25, found));
  EXPECT_DOUBLE_EQ(found.time, 1.25);
  EXPECT_DOUBLE_EQ(found.path, 12.5);
  EXPECT_DOUBLE_EQ(found.correction, 1.5);
  EXPECT_DOUBLE_EQ(found.filament, 1);
  EXPECT_TRUE(found.X_WT.isApprox(make_pose(exp_rotation(Vec3(0, 0, from_deg(20))), Vec3(0, 2, 0)), 1e-12));
  EXPECT_TRUE(found.printing) << "the way to b feeds filament";
  EXPECT_EQ(found.line, 4);
}

TEST(CommandHistory, AfterTheLatestTheToolStandsThere) {
  CommandHistory history(0.5, 1e-3);
  history.push(at_cycle(1));
  history.push(at_cycle(2));
  Commanded found;
  ASSERT_TRUE(history.at(99, found));
  EXPECT_EQ(found.time, 2e-3);
  EXPECT_EQ(found.line, 2);
}

TEST(CommandHistory, KeepsItsSpanAndForgetsWhatIsOlder) {
  CommandHistory history(10e-3, 1e-3);
  for (int pushed = 1; pushed <= 25; ++pushed) {
    history.push(at_cycle(pushed));
    const int oldest = std::max(1, pushed - 9);
    Commanded found;
    EXPECT_FALSE(history.at(1e-3 * oldest - 1e-6, found)) << pushed;
    for (double cycle = oldest; cycle <= pushed; cycle += 0.25) {
      ASSERT_TRUE(history.at(1e-3 * cycle, found)) << cycle << " of " << pushed;
      // Everything is proportional to time, so that any place of the ring has one answer.
      EXPECT_NEAR(found.path, 5e-6 * cycle, 1e-15);
      EXPECT_NEAR(found.correction, -2e-6 * cycle, 1e-15);
      EXPECT_NEAR(found.X_WT.translation().x(), 7e-6 * cycle, 1e-15);
    }
    EXPECT_EQ(history.latest().line, pushed);
  }
}

}  // namespace
}  // namespace understudy::control
