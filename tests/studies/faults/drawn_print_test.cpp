#include "studies/faults/drawn_print.h"

#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::studies {
namespace {

TEST(DrawnPrint, EverySortIsDrawnAndNoneIsLong) {
  const auto machine = machine::load_machine("hexapod");
  std::set<std::string> sorts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, "print");
    try {
      const DrawnPrint print = draw_print(machine, random);
      sorts.insert(print.what);
      double bead = 0;
      Vec3 tip = Vec3::Zero();
      for (const toolpath::Step& step : print.program.steps) {
        if (!toolpath::moves(step)) continue;
        if (step.kind == toolpath::StepKind::print) bead += (step.X_WT.translation() - tip).norm();
        tip = step.X_WT.translation();
      }
      EXPECT_GT(bead, 1e-3) << seed;
      EXPECT_LE(bead, 60e-3) << seed;
    } catch (const InputError&) {  // refused: the caller draws again
    }
  }
  EXPECT_EQ(sorts, (std::set<std::string>{"bottle line", "surface", "layers", "spiral"}));
}

TEST(DrawnPrint, EqualStreamsDrawEqualPrograms) {
  const auto machine = machine::load_machine("arm");
  const auto text = [&](std::uint64_t seed) -> std::string {
    Random random(seed, "print");
    try {
      return toolpath::write_gcode(draw_print(machine, random).program, {});
    } catch (const InputError& error) {
      return error.what();
    }
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) EXPECT_EQ(text(seed), text(seed));
  EXPECT_NE(text(0), text(1));
}

}  // namespace
}  // namespace understudy::studies
