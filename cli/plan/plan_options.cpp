#include "cli/plan/plan_options.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "control/motion/rotary_turns.h"
#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::cli {

void add_machine_option(CLI::App& command, PlanOptions& options) {
  command.add_option("--machine", options.machine, "gap, filament and tool come from it")
      ->capture_default_str();
}

void add_motion_options(CLI::App& command, PlanOptions& options) {
  command.add_option("--feed", options.feed_mm_per_s, "mm/s")->capture_default_str();
  command.add_option("--approach-feed", options.approach_mm_per_s, "mm/s, down to where a bead begins")
      ->capture_default_str();
  command.add_option("--clearance", options.clearance_mm, "mm above what is printed, for travel")
      ->capture_default_str();
}

void add_bead_options(CLI::App& command, PlanOptions& options) {
  command.add_option("--width", options.bead_width_mm, "mm, width of the bead")->capture_default_str();
  command.add_option("--height", options.bead_height_mm, "mm, height of the bead; 0: the gap")
      ->capture_default_str();
}

void add_nozzle_options(CLI::App& command, PlanOptions& options) {
  command.add_option("--temperature", options.temperature_c, "C, nozzle")->capture_default_str();
  command.add_option("--fan", options.fan, "0..1")->check(CLI::Range(0.0, 1.0))->capture_default_str();
}

void add_output_option(CLI::App& command, PlanOptions& options) {
  command.add_option("-o,--output", options.output, "G-code to write")->required();
  command.add_flag(
      "--rotary-words", options.rotary_words,
      "state the tool's orientation by the turning axes of the machine, such as B and C, instead of "
      "W I J K");
  command.add_flag("-q,--quiet", options.quiet, "no progress, and no word about what was written");
}

void print_written(const PlanOptions& options, const std::string& what) {
  if (!options.quiet) fmt::print("{}: {}\n", options.output, what);
}

void check_option(const char* name, double value, double limit) {
  if (!(value > 0) || value > limit)
    throw InputError(fmt::format("{} {:g} is outside 0..{:g}", name, value, limit));
}

void check_options(const PlanOptions& o) {
  check_writable(o.output);
  if (o.rotary_words) control::rotary_style(machine::load_machine(o.machine));
  check_option("--feed", o.feed_mm_per_s, 500);
  check_option("--approach-feed", o.approach_mm_per_s, 50);
  check_option("--clearance", o.clearance_mm, 100);
  check_option("--width", o.bead_width_mm, 10);
  if (!(o.bead_height_mm >= 0 && o.bead_height_mm <= 10))
    throw InputError(fmt::format("--height {:g} is outside 0..10", o.bead_height_mm));
  if (!(o.temperature_c >= 100 && o.temperature_c <= 450))
    throw InputError(fmt::format("--temperature {:g} C is outside 100..450 C", o.temperature_c));
}

Vec3 place_from(const char* option, const std::string& text) {
  std::istringstream table("x,y,z\n" + text + "\n");
  try {
    const auto rows = read_number_table(table, option, {"x", "y", "z"});
    if (rows.size() == 1) return kMillimetre * Vec3(rows[0].values[0], rows[0].values[1], rows[0].values[2]);
  } catch (const InputError&) {  // its place would be a line of a file that is none
  }
  throw InputError(fmt::format("{} '{}' is not X,Y,Z in mm", option, text));
}

machine::MachineDescription printing_machine(const std::string& name) {
  auto machine = machine::load_machine(name);
  if (!machine.tool.prints())
    throw InputError(fmt::format("machine {} has a nozzle of 0 mm: its tool does not print", machine.name));
  return machine;
}

double bead_height(const PlanOptions& options, const machine::MachineDescription& machine) {
  return options.bead_height_mm > 0 ? from_mm(options.bead_height_mm) : machine.gap.aim;
}

void write_program(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const PlanOptions& options, const std::vector<std::string>& notes) {
  std::vector<std::string> header = {"planned by: " + command_line()};
  header.insert(header.end(), notes.begin(), notes.end());
  toolpath::GcodeStyle style = options.rotary_words ? control::rotary_style(machine) : toolpath::GcodeStyle();
  style.extruder_letter = machine.dialect.extruder_letter;
  style.commands = machine.dialect.commands_for_tips();
  write_file(options.output,
             toolpath::write_gcode(options.rotary_words ? control::with_turns(program, machine) : program,
                                   header, style));
}

}  // namespace understudy::cli
