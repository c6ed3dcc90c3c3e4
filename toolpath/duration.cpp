#include "toolpath/duration.h"

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::toolpath {

double least_duration(const Step& step, const Vec3& from_W) {
  if (step.duration > 0) return step.duration;
  if (!moves(step) || step.kind == StepKind::travel || !(step.feed > 0)) return 0;
  return (step.X_WT.translation() - from_W).norm() / step.feed;
}

void check_duration(const Program& program, const Vec3& start_W, double limit) {
  double time = 0;
  Vec3 tip_W = start_W;
  for (const Step& step : program.steps) {
    time += least_duration(step, tip_W);
    if (!(time <= limit))
      throw InputError(
          {program.file, step.line, 0},
          fmt::format("by here the program takes {:.3g} s or more; {:.6g} s are simulated at most: "
                      "mend its feeds and dwells, or allow more by --max-time",
                      time, limit));
    if (moves(step)) tip_W = step.X_WT.translation();
  }
}

}  // namespace understudy::toolpath
