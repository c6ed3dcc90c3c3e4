#include "rehearsal/inspection/inspect_robot.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/quantile.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/inspection/place_on_table.h"
#include "rehearsal/program/program_reading.h"
#include "rehearsal/program/robot_reading.h"

namespace understudy::rehearsal {
namespace {

constexpr double kBeadWidth = 1.2;  // nozzle diameters, where a program does not tell
constexpr double kBeadHeight = 0.5;

double hundredths(double metres) { return std::round(1e2 * to_mm(metres)) / 1e2; }

}  // namespace

Inspection inspect_robot(const std::string& program, const std::string& text, const std::string& machine) {
  Inspection result;
  const machine::MachineDescription description = machine::load_machine(machine);
  const double nozzle = description.tool.nozzle_diameter;
  DialectRequest& dialect = result.request.dialect;
  result.request.program = program;
  result.request.machine = machine;
  result.machine_nozzle = nozzle;
  result.lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  result.told_by = toolpath::has_robot_ending(program) ? "its ending" : "its content";
  result.robot.emplace();

  const auto read = [&](bool strict) {
    toolpath::RobotOptions options = robot_options(dialect, description);
    options.unknown = strict ? nullptr : &result.unknown;
    options.facts = strict ? nullptr : &*result.robot;
    const toolpath::Program steps = toolpath::read_robot_program(program, text, options);
    if (!strict)  // where the program puts it, as of G-code
      result.summary =
          toolpath::summarise(steps, options.X_WT_home.translation(), description.tool.filament_diameter);
  };
  // The bead: as high as its layers, and a little wider than the nozzle.
  const auto bead = [&](double height) {
    dialect.robot.bead_mm = {hundredths(std::max(kBeadWidth * nozzle, height)), hundredths(height)};
  };
  bead(kBeadHeight * nozzle);
  read(false);
  const auto& heights = result.summary.layer_heights;
  if (const double height = heights.empty() ? 0 : quantile(heights, 0.5); to_mm(height) >= 0.01) {
    bead(height);
    read(false);
  }
  for (const auto& word : result.unknown) dialect.ignored.push_back(word.word);
  if (result.robot->signal.size() < result.robot->outputs.size())
    dialect.robot.signals = result.robot->signal;
  if (result.robot->signal.empty()) dialect.robot.bead_mm = {0, 0};
  if (const auto& printed = result.summary.printed)
    dialect.place_mm =
        place_on_table(*printed, *printed, description, from_mm(dialect.robot.bead_mm[1]), true);
  try {
    read(true);
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find("--tool-points") == std::string_view::npos) throw;
    dialect.robot.tool_points = result.robot->tool_points;
  }
  return result;
}

}  // namespace understudy::rehearsal
