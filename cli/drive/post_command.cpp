#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/print_request.h"
#include "control/print.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "core/version.h"
#include "drivers/gcode/gcode_words.h"
#include "drivers/gcode/post_port.h"

namespace understudy::cli {
namespace {

struct PostOptions {
  PrintRequest print;
  std::string family, output, axes, extruder;
  double tolerance_um = 2, tolerance_ms = 1, tolerance_deg = 0.001, longest_ms = 1000;
  bool no_outputs = false;
};

drivers::FitTolerance tolerance_of(const PostOptions& options) {
  drivers::FitTolerance tolerance;
  tolerance.length = 1e-6 * options.tolerance_um;
  tolerance.time = 1e-3 * options.tolerance_ms;
  tolerance.angle = from_deg(options.tolerance_deg);
  tolerance.block_time_max = 1e-3 * options.longest_ms;
  return tolerance;
}

std::string header(const PostOptions& options, const PreparedPrint& print) {
  return fmt::format(
      "; understudy {}\n; {} (sha256 {}) on {} (sha256 {}) for {}\n"
      "; axis positions, from home; the path within {:g} um and {:g} ms\n",
      kVersion, std::filesystem::path(options.print.program).filename().string(), print.program.sha256,
      print.machine.name, print.machine.sha256, options.family, options.tolerance_um, options.tolerance_ms);
}

kinematics::AxisVector home_of(const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  kinematics::AxisVector home{};
  const auto axes = std::span(home).first(static_cast<std::size_t>(mechanism->axis_count()));
  const auto solved = mechanism->inverse(machine.X_BT_home, {}, axes);
  if (solved != kinematics::SolveStatus::ok && solved != kinematics::SolveStatus::singular)
    throw InputError(machine.file.string() + ": the home pose cannot be reached: " + to_string(solved));
  return home;
}

int post(PostOptions options) {
  check_writable(options.output);
  if (options.print.gap_control == "start" || options.print.gap_control == "continuous")
    throw InputError("--gap-control: a program that is written beforehand has no camera: off");
  options.print.gap_control = "off";
  const PreparedPrint print = prepare_print(options.print);
  drivers::PortUri words;
  words.text = "--for " + options.family;
  if (!options.axes.empty()) words.options["axes"] = options.axes;
  if (!options.extruder.empty()) words.options["extruder"] = options.extruder;
  const drivers::GcodeFamily family = drivers::gcode_family(options.family);
  if (family == drivers::GcodeFamily::linuxcnc)
    throw InputError(
        "--for linuxcnc: it is driven (--port tcp://host:5007?family=linuxcnc), and no file is written for "
        "it");
  const drivers::GcodeAxes axes = drivers::gcode_axes(family, print.machine, words);

  std::string text = header(options, print);
  drivers::PostPort port(print.machine, {family, axes, tolerance_of(options), !options.no_outputs},
                         home_of(print.machine), [&](const std::string& line) { text += line + "\n"; });
  port.begin();
  control::PrintOptions how;
  how.gap_control = control::GapControl::off;
  const control::PrintResult result = control::print(print.program, print.machine, port, how);
  if (!result.completed) throw InputError({options.print.program, result.stop.line}, result.stop.why);
  write_file(options.output, text);
  const drivers::PostFigures& figures = port.figures();
  fmt::print(
      "{}: {} blocks, {} bytes for {:.1f} s of motion: {:.1f} blocks/s, at most {} blocks and {} bytes in a "
      "second\n",
      options.output, figures.blocks, figures.bytes, figures.duration,
      static_cast<double>(figures.blocks) / std::max(1e-9, figures.duration), figures.blocks_in_second,
      figures.bytes_in_second);
  return kGood;
}

}  // namespace

void add_post(CLI::App& app, Action& action) {
  auto options = std::make_shared<PostOptions>();
  auto* command =
      app.add_subcommand("post", "Write the blocks that drive would send, for a controller without a driver");
  add_print_options(*command, options->print);
  command->add_option("--for", options->family, "the controller: grblhal, marlin or reprapfirmware")
      ->required();
  command->add_option("-o,--output", options->output, "file to write")->required();
  command->add_option(
      "--axes", options->axes,
      "letters of the machine's axes on the controller, such as XYZUVW; without it the family's");
  command->add_option("--extruder", options->extruder, "letter of the filament's axis, or none");
  command->add_flag("--no-outputs", options->no_outputs, "leave out heater and fan");
  command->add_option("--tolerance-um", options->tolerance_um, "um: of the path in axis coordinates")
      ->check(CLI::Range(0.5, 1000.))
      ->capture_default_str();
  command->add_option("--tolerance-deg", options->tolerance_deg, "degrees: of turning axes")
      ->check(CLI::Range(1e-4, 1.))
      ->capture_default_str();
  command->add_option("--tolerance-ms", options->tolerance_ms, "ms: of the time at which it is passed")
      ->check(CLI::Range(0., 100.))
      ->capture_default_str();
  command->add_option("--longest-ms", options->longest_ms, "ms: that a block lasts at most")
      ->check(CLI::Range(10., 10000.))
      ->capture_default_str();
  command->footer(
      "understudy post scenarios/song-bottle.gcode --machine hexapod --for marlin -o bottle-marlin.gcode");
  command->callback([=, &action] { action = [=] { return post(*options); }; });
}

}  // namespace understudy::cli
