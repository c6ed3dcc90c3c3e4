#include "tests/fuzz/robot_programs.h"

#include <fmt/format.h>

#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {

std::vector<toolpath::RobotOptions> robot_readings(std::vector<toolpath::UnknownWordCount>& unknown,
                                                   toolpath::RobotFacts& facts) {
  toolpath::RobotOptions bead;
  bead.X_WT_home = make_pose(Quat::Identity(), Vec3(0, 0, 60e-3));
  bead.extruder.bead_area = 0.1e-6;
  toolpath::RobotOptions flow = bead;
  flow.extruder.bead_area.reset();
  flow.extruder.flow_per_unit = 4e-9;
  flow.unknown = &unknown;
  flow.facts = &facts;
  toolpath::RobotOptions always = bead;
  always.extruder.outputs = {"always"};
  always.tool_points = "x";
  always.offset_W = Vec3(1e-3, 2e-3, 3e-3);
  return {bead, flow, always};
}

void check_robot_program(const toolpath::Program& program, const toolpath::RobotOptions& options) {
  for (const toolpath::Step& step : program.steps) {
    const Mat3 R = step.X_WT.linear();
    require_near(R.determinant(), 1, 1e-6, 0, fmt::format("line {}: determinant", step.line));
    require(step.filament >= 0, fmt::format("line {}: filament is taken back", step.line));
  }
  toolpath::GcodeOptions gcode;
  gcode.X_WT_home = options.X_WT_home;
  check_program(program, gcode);
}

}  // namespace understudy::fuzz
