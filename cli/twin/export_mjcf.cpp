#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/seed_option.h"
#include "core/file/output_file.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/plant/plant.h"

namespace understudy::cli {
namespace {

struct MjcfRequest {
  std::string machine = machine::kDefaultMachine, as_built, output;
  std::uint64_t seed = 1;
};

int export_mjcf(const MjcfRequest& r) {
  check_writable(r.output);
  const auto machine = machine::load_machine(r.machine);
  const auto as_built =
      r.as_built.empty() ? sim::as_described(machine) : sim::make_as_built(machine, r.as_built, r.seed);
  write_file(r.output, sim::write_mjcf(machine, as_built, machine.X_WB * machine.X_BT_home));
  fmt::print("{}\n", r.output);
  return kGood;
}

}  // namespace

void add_export_mjcf(CLI::App& command, Action& action) {
  auto request = std::make_shared<MjcfRequest>();
  auto* mjcf = command.add_subcommand("mjcf", "MuJoCo's XML, assembled at home");
  add_machine_option(*mjcf, request->machine);
  mjcf->add_option(
      "--as-built", request->as_built,
      "nominal, sampled, manufactured, calibrated or a file; without it as the machine file has it");
  mjcf->add_option("--seed", request->seed, "of the as-built errors")
      ->check(seed_check())
      ->capture_default_str();
  mjcf->add_option("-o,--output", request->output, "file to write")->required();
  mjcf->callback([=, &action] { action = [=] { return export_mjcf(*request); }; });
}

}  // namespace understudy::cli
