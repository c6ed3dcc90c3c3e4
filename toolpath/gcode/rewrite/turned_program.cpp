#include "toolpath/gcode/rewrite/turned_program.h"

#include "core/error.h"

namespace understudy::toolpath {
namespace {

Mat3 about_z(double angle) { return exp_rotation(angle * Vec3::UnitZ()); }

}  // namespace

Pose turned_pose(const Pose& X_UT, const Vec3& origin_W, const ProgramTurn& by) {
  const Mat3 R_WU = about_z(by.turn);
  return make_pose(Mat3(R_WU * X_UT.linear() * about_z(by.spin - by.turn)),
                   Vec3(origin_W + R_WU * (X_UT.translation() - origin_W)));
}

Program parse_turned_gcode(const std::string& text, const std::string& file, const GcodeOptions& options,
                           const ProgramTurn& by) {
  if (by.turn == 0 && by.spin == 0) return parse_gcode(text, file, options);
  // The reader works in U: there home is elsewhere.
  GcodeOptions in_U = options;
  const Vec3 p_WH = options.X_WT_home.translation();
  in_U.X_WT_home.translation() = options.offset_W + about_z(-by.turn) * (p_WH - options.offset_W);
  Program program = parse_gcode(text, file, in_U);
  bool at_home = true;
  for (Step& step : program.steps) {
    if (step.rotary && (step.rotary->b != options.rotary->b_home || step.rotary->c != options.rotary->c_home))
      throw InputError({program.file, step.line, 0}, "a program of rotary words cannot be turned or spun");
    at_home = step.kind == StepKind::home || (at_home && step.X_WT.isApprox(in_U.X_WT_home, 0));
    step.X_WT = at_home ? options.X_WT_home : turned_pose(step.X_WT, options.offset_W, by);
    step.rotary.reset();
  }
  return program;
}

}  // namespace understudy::toolpath
