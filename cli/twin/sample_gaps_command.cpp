#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/seed_option.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "report/picture/png.h"
#include "studies/gap/sample_gaps.h"

namespace understudy::cli {
namespace {

struct SampleGapsCall {
  studies::SampleGapsRequest request;
  std::string machine = machine::kDefaultMachine, output;
  std::vector<double> heights_mm{0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 1.9};
  double wedge_deg = 0, feeler_mm = 0.1, feeler_sigma_um = 5, height_sigma_um = 0;
  bool no_speckle = false;
};

int run_sample_gaps(const SampleGapsCall& call) {
  studies::SampleGapsRequest request = call.request;
  for (const double height : call.heights_mm) request.heights.push_back(from_mm(height));
  request.wedge = from_deg(call.wedge_deg);
  request.feeler = from_mm(call.feeler_mm);
  request.feeler_sigma = kMicrometre * call.feeler_sigma_um;
  request.height_sigma = kMicrometre * call.height_sigma_um;
  request.speckle = !call.no_speckle;
  const auto machine = machine::load_machine(call.machine);
  OutputFolder folder(call.output);
  const auto sample =
      studies::sample_gaps(request, machine, [&](const std::string& name, const Image& picture) {
        write_file(folder.path() / name, report::encode_png(picture));
      });
  std::filesystem::create_directories(folder.path() / "truth");
  write_file(folder.path() / "table.csv",
             "# by: " + printable(command_line(), std::string::npos) + "\n" + sample.table);
  write_file(folder.path() / "truth/gaps.csv", sample.truth);
  write_file(folder.path() / "truth/as-built.yaml", sample.as_built);
  folder.commit();
  fmt::print("{} pictures: {}\n", sample.pictures,
             (std::filesystem::path(call.output) / "table.csv").string());
  return kGood;
}

}  // namespace

void add_sample_gaps(CLI::App& app, Action& action) {
  auto call = std::make_shared<SampleGapsCall>();
  auto* command = app.add_subcommand(
      "sample-gaps", "Pictures of the dot over a flat, of a twin whose laser and microscope are misplaced");
  add_machine_option(*command, call->machine);
  command->add_option("--heights", call->heights_mm, "mm, commanded, from a zero that is not known")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--wedge", call->wedge_deg,
                   "deg; above 0: over two wedges, too, that lean towards x and y")
      ->check(CLI::Range(0.0, 30.0))
      ->capture_default_str();
  command->add_option("--feeler", call->feeler_mm, "mm, the gap that is known over each flat")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str();
  command->add_option("--feeler-sigma", call->feeler_sigma_um, "um, 1 sigma of it")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--height-sigma", call->height_sigma_um, "um, 1 sigma of each commanded height")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_flag("--no-speckle", call->no_speckle, "incoherent light");
  command
      ->add_option("--as-built", call->request.as_built,
                   "the machine that stands there: nominal, manufactured, or a file of as-built parameters")
      ->capture_default_str();
  command
      ->add_option("--seed", call->request.seed,
                   "of the machine as built, the flat's roughness and the noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "folder: pictures, table.csv, and the truth under truth/")
      ->required();
  command->footer(
      "Then: understudy calibrate gap-sensor FOLDER/table.csv -o calibrated.yaml\n"
      "truth/as-built.yaml is the machine that stood there, for --as-built of other commands; truth/gaps.csv "
      "has "
      "the true gaps, which no command reads.");
  command->callback([=, &action] { action = [=] { return run_sample_gaps(*call); }; });
}

}  // namespace understudy::cli
