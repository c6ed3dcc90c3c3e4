#include "cli/options/print_request.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "control/gap_control_word.h"
#include "control/program/gcode_options.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "toolpath/gcode/rewrite/turned_program.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::cli {
namespace {

toolpath::Program read_print(const PrintRequest& request, const machine::MachineDescription& machine) {
  const std::string text = read_file(request.program);
  if (toolpath::robot_language(request.program, text))
    throw InputError(request.program +
                     ": a robot's own program runs on the robot's controller; a print is driven from G-code");
  const toolpath::ProgramTurn turn{from_deg(request.dialect.turn_deg), from_deg(request.dialect.spin_deg)};
  toolpath::Program program = toolpath::parse_turned_gcode(
      text, request.program, control::gcode_options(request.dialect, machine), turn);
  control::heat_first(request.dialect, machine, program);
  return program;
}

/// The words of a command, with those that are read here in `request`; the rest.
std::vector<std::string> read_words(const std::string& command_line, PrintRequest& request) {
  std::vector<std::string> words = split_command_line(command_line);
  CLI::App app;
  app.allow_extras();
  add_print_options(app, request);
  if (words.size() > 2) words.erase(words.begin(), words.begin() + 2);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
    check_numbers(app);
  } catch (const CLI::Error& error) {
    throw InputError("'" + command_line + "': " + error.what());
  }
  return app.remaining();
}

/// What differs, as an option; empty: nothing.
std::string difference(const PrintRequest& a, const PrintRequest& b) {
  const control::DialectRequest &x = a.dialect, &y = b.dialect;
  if (x.place_mm != y.place_mm) return "--place";
  if (x.turn_deg != y.turn_deg) return "--turn";
  if (x.spin_deg != y.spin_deg) return "--spin";
  if (x.extruder_letter != y.extruder_letter) return "--extruder-letter";
  if (x.relative_extrusion != y.relative_extrusion) return "--relative-extrusion";
  if (x.b_sign != y.b_sign) return "--b-sign";
  if (x.c_sign != y.c_sign) return "--c-sign";
  if (x.ignored != y.ignored) return "--ignore";
  if (x.macros != y.macros) return "--macros";
  if (x.temperature_c != y.temperature_c) return "--temperature";
  if (x.coordinates != y.coordinates) return "--coordinates";
  return "";
}

}  // namespace

void add_print_options(CLI::App& command, PrintRequest& request) {
  command.add_option("program", request.program, "G-code, with the tool's orientation at each point")
      ->required();
  add_machine_option(command, request.machine);
  command.add_option("--fixture", request.fixture,
                     "the inserted part: an STL in mm, or a name under models/parts");
  command
      .add_option(
          "--gap-control", request.gap_control,
          "off; start: close the gap before each print move by laser and camera; continuous: and follow "
          "it along the path; start where the machine has them")
      ->check(CLI::IsMember({"off", "start", "continuous"}));
  add_dialect_options(command, request.dialect);
}

PreparedPrint prepare_print(const PrintRequest& request) {
  const control::DialectRequest& dialect = request.dialect;
  if (dialect.place_auto)
    throw InputError("--place auto: name the place that `understudy place` finds, as X,Y,Z");
  if (dialect.nozzle_mm)
    throw InputError("--nozzle: write the bore of the nozzle that is mounted into the machine file");
  PreparedPrint print;
  print.machine = machine::load_machine(request.machine);
  print.gap_control = control::gap_control_of(request.gap_control, print.machine);
  print.program = read_print(request, print.machine);
  if (request.fixture.empty()) return print;
  const auto file = machine::find_fixture(request.fixture);
  print.part = geometry::read_stl(file);
  print.fixture_sha256 = sha256_hex(read_file(file));
  return print;
}

PrintRequest rehearsed_request(const std::string& rehearse_command) {
  PrintRequest request;
  const std::vector<std::string> rest = read_words(rehearse_command, request);
  for (const char* option : {"--register", "--home-axes"})
    if (std::ranges::find(rest, option) != rest.end())
      throw InputError(fmt::format(
          "the rehearsal had {}, which a print on the machine has not: rehearse it without", option));
  return request;
}

PrintRequest given_over(const PrintRequest& rehearsed, const std::string& drive_command) {
  PrintRequest request = rehearsed;
  static_cast<void>(read_words(drive_command, request));
  return request;
}

void require_rehearsal(const std::string& folder, const report::RecordedRun& run,
                       const PrintRequest& rehearsed, const PrintRequest& asked, const PreparedPrint& print) {
  const auto refuse = [&](const std::string& why) {
    return InputError(fmt::format("{}: {}; rehearse it again, or print it --without-rehearsal", folder, why));
  };
  if (const std::string why = why_not_as_written(folder); !why.empty()) throw refuse(why);
  if (!run.go) throw refuse("the rehearsal says no-go");
  if (run.program_sha256 != print.program.sha256)
    throw refuse(fmt::format("it is the rehearsal of another program than {} is now", asked.program));
  if (run.machine_sha256 != print.machine.sha256)
    throw refuse(fmt::format("it is the rehearsal on another machine file than {} is now", asked.machine));
  if (run.fixture_sha256 != print.fixture_sha256)
    throw refuse(asked.fixture.empty() ? "the rehearsal had a --fixture"
                 : run.fixture_sha256.empty()
                     ? "the rehearsal had no --fixture"
                     : fmt::format("the rehearsal had another --fixture than {} is now", asked.fixture));
  if (control::gap_control_of(rehearsed.gap_control, print.machine) != print.gap_control)
    throw refuse("the rehearsal had another --gap-control");
  if (const std::string option = difference(rehearsed, asked); !option.empty())
    throw refuse(fmt::format("the rehearsal had another {}", option));
}

}  // namespace understudy::cli
