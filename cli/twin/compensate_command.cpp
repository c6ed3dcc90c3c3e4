#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/progress.h"
#include "cli/twin/compensation_commands.h"
#include "cli/twin/rehearse_options.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "rehearsal/compensation/compensate.h"

namespace understudy::cli {
namespace {

struct CompensateCall {
  rehearsal::CompensationRequest request;
  std::string output, play_from = "middle";
  OutputOptions told;
};

void print_answer(const CompensateCall& call, const rehearsal::Compensation& done) {
  fmt::print(
      "{}: {} lines go elsewhere, by {:.3f} mm at most; {} lines added, so that the tip keeps within {:g} "
      "um\n",
      call.output, done.lines, to_mm(done.largest_move), done.added_lines, call.request.tolerance_um);
  if (call.told.quiet) return;
  if (done.kept_moves > 0)
    fmt::print("  {} moves stay as they are: homing and macros say no place of their own\n", done.kept_moves);
  fmt::print(
      "  predicted tip error of the nominal controller, RMS while printing: {:.1f} um with the original, "
      "{:.1f} um with the geometry put right",
      to_um(done.predicted_before), to_um(done.predicted_geometry));
  if (call.request.play && done.rounds > 0)
    fmt::print(", {:.1f} um with the play, too", to_um(done.predicted));
  else if (call.request.play)
    fmt::print("; correcting the play would not make it smaller, so it is left");
  fmt::print("\n");
  if (call.request.play)
    fmt::print(
        "  plays count from {} (--play-from)\n",
        call.request.reference == rehearsal::PlayReference::rest
            ? "where they rest at home"
            : "their middle: for poses that were measured on a machine with play, see docs/compensation.md");
}

int run_compensate(const CompensateCall& call) {
  check_writable(call.output);
  rehearsal::CompensationRequest request = call.request;
  request.reference =
      call.play_from == "rest" ? rehearsal::PlayReference::rest : rehearsal::PlayReference::middle;
  rehearsal::Compensation done;
  {
    ProgressLine line(!call.told.quiet);
    done = rehearsal::compensate(request, line.teller());
  }
  stop_if_interrupted();
  StagedFile(call.output, done.text).commit();
  CompensateCall told = call;
  told.request = request;
  print_answer(told, done);
  return kGood;
}

}  // namespace

void add_compensate(CLI::App& app, Action& action) {
  auto call = std::make_shared<CompensateCall>();
  auto* command = app.add_subcommand(
      "compensate",
      "Rewrite a program so that a controller that knows no calibration puts the tip where it was asked for");
  command->add_option("program", call->request.program, "G-code, in any dialect that `rehearse` reads")
      ->required();
  command
      ->add_option("--machine", call->request.machine,
                   "the calibrated machine: a machine.yaml of `calibrate`")
      ->required();
  command->add_option("--nominal", call->request.nominal,
                      "what the controller holds: the machine before its calibration, a name or a "
                      "machine.yaml; without it the calibrated file's own drawing");
  command->add_option("-o,--output", call->output, "the compensated program")->required();
  command
      ->add_option("--tolerance", call->request.tolerance_um,
                   "um, by which the tip may leave the compensated way between two points of a line")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_flag("!--no-play", call->request.play, "put the geometry right only, not the play");
  command
      ->add_option(
          "--play-from", call->play_from,
          "what the calibration counts the plays from: their middle, or where they rest at home (poses "
          "that were measured on a machine with play)")
      ->check(CLI::IsMember({"middle", "rest"}))
      ->capture_default_str();
  add_quiet_option(*command, call->told, "no progress, and the first line of the answer alone");
  add_dialect_options(*command, call->request.dialect);
  command->footer(
      "Example:\n"
      "  understudy calibrate measured.csv --machine hexapod -o calibrated.yaml\n"
      "  understudy compensate line.gcode --machine calibrated.yaml -o compensated.gcode\n"
      "  understudy rehearse compensated.gcode --machine hexapod --as-built manufactured "
      "--seed 5\n"
      "Comments, words without effect and lines stay where they were (docs/compensation.md).");
  command->callback([=, &action] { action = [=] { return run_compensate(*call); }; });
}

}  // namespace understudy::cli
