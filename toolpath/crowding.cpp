#include "toolpath/crowding.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {

void check_crowding(const Program& program) {
  std::map<std::array<std::int64_t, 3>, int> counts;  // by the cell of a grid of 1 mm
  for (const Step& step : program.steps) {
    if (step.kind != StepKind::print) continue;
    const Vec3 end_W = step.X_WT.translation();
    std::array<std::int64_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i)
      cell[i] = static_cast<std::int64_t>(std::floor(to_mm(end_W[static_cast<int>(i)])));
    if (++counts[cell] > kCrowdingMax)
      throw InputError(
          {program.file, step.line, 0},
          fmt::format("more than {} moves that print end in the cubic millimetre from ({}, {}, {}) mm on: "
                      "no print needs them; join moves that are shorter than the machine can tell",
                      kCrowdingMax, cell[0], cell[1], cell[2]));
  }
}

}  // namespace understudy::toolpath
