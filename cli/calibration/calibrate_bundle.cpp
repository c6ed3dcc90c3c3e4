#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "calibration/bundle/calibrate_bundle.h"
#include "cli/calibration/calibrate_bundle.h"
#include "cli/calibration/calibration_output.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "core/units.h"

namespace understudy::cli {
namespace {

struct BundleCall {
  calibration::BundleRequest request;
  double warming_um = 0;
  std::string output, report;
  OutputOptions told;
};

int run_bundle(const BundleCall& call) {
  CalibrationOutput output(call.output, call.report);
  calibration::BundleRequest request = call.request;
  request.warming = kMicrometre * call.warming_um;
  request.command = command_line();
  return output.write(calibration::calibrate_bundle(request), call.told);
}

}  // namespace

CLI::App* add_calibrate_bundle(CLI::App& calibrate, Action& action) {
  auto call = std::make_shared<BundleCall>();
  auto* command = calibrate.add_subcommand(
      "bundle", "Find machine, cameras and boards together, from all corners and targets in pixels");
  command->add_option("--rig", call->request.rig, "the measuring set-up (docs/measuring-pictures.md)")
      ->required();
  command->add_option("--corners", call->request.corners, "CSV of understudy measure board")->required();
  command->add_option("--targets", call->request.targets, "CSV of understudy measure targets")->required();
  command->add_option("--commanded", call->request.commanded, "CSV of the commanded poses, as measure had it")
      ->required();
  add_machine_option(*command, call->request.machine);
  command
      ->add_option("--warming", call->warming_um,
                   "um by which the struts may have grown while poses were measured; 0: they have not")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "calibrated machine file, a .yaml")->required();
  command->add_option("--report", call->report, "folder for report.html and summary.json");
  add_output_options(*command, call->told, "the name of the calibrated machine file alone", "the summary");
  command->footer(
      "Boards may be off their places within the tolerances of the rig's file. The plays of the struts are "
      "found "
      "where the commanded poses have a1..a6.\n"
      "Example: understudy measure board --rig shots/rig.yaml -o corners.csv\n"
      "         understudy measure targets shots/poses/*.png --rig shots/rig.yaml --commanded "
      "shots/commanded.csv -o targets.csv\n"
      "         understudy calibrate bundle --rig shots/rig.yaml --corners corners.csv --targets targets.csv "
      "--commanded shots/commanded.csv -o calibrated.yaml");
  command->callback([=, &action] { action = [=] { return run_bundle(*call); }; });
  return command;
}

}  // namespace understudy::cli
