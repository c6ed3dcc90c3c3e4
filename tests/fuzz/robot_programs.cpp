#include "tests/fuzz/robot_programs.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

// An arc becomes many chords, also before a line behind it is refused.
constexpr std::size_t kStepsBeforeRefusal = kChords;

std::vector<toolpath::RobotOptions> robot_readings(std::vector<toolpath::UnknownWordCount>& unknown,
                                                   toolpath::RobotFacts& facts) {
  toolpath::RobotOptions bead;
  bead.X_WT_home = make_pose(Quat::Identity(), Vec3(0, 0, 60e-3));
  bead.extruder.bead_area = 0.1e-6;
  bead.chords_max = kChords;
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

}  // namespace

void check_robot_reader(std::size_t bytes, const std::string& file,
                        const std::function<toolpath::Program(const toolpath::RobotOptions&)>& read) {
  std::vector<toolpath::UnknownWordCount> unknown;
  toolpath::RobotFacts facts;
  for (const toolpath::RobotOptions& options : robot_readings(unknown, facts)) {
    toolpath::Program program;
    const auto made = [&] { return std::max(kStepsBeforeRefusal, program.steps.size()); };
    if (accepts(
            bytes, file, [&] { program = read(options); }, made))
      check_robot_program(program, options);
  }
}

}  // namespace understudy::fuzz
