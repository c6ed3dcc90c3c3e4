#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/export_video_command.h"
#include "cli/options/machine_option.h"
#include "cli/urdf_of.h"
#include "core/file/output_file.h"
#include "machine/description.h"

namespace understudy::cli {
namespace {

struct UrdfRequest {
  std::string machine, output;
};

int export_urdf(const UrdfRequest& r) {
  check_writable(r.output);
  const auto machine = machine::load_machine(r.machine);
  write_file(r.output, urdf_of(machine));
  fmt::print("{}\n", r.output);
  return kGood;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("export", "Write a machine's model, or a rehearsal, for other programs");
  command->require_subcommand(1);
  auto request = std::make_shared<UrdfRequest>();
  add_export_mjcf(*command, action);
  add_export_trace(*command, action);
  add_export_glb(*command, action);
  add_export_video(*command, action);
  add_export_hal(*command, action);
  add_export_linuxcnc(*command, action);
  auto* urdf =
      command->add_subcommand("urdf", "URDF of an open chain: links \"work\" and \"tool\" at its ends");
  add_machine_option(*urdf, request->machine)->required();
  urdf->add_option("-o,--output", request->output, "file to write")->required();
  urdf->callback([=, &action] { action = [=] { return export_urdf(*request); }; });
}

}  // namespace understudy::cli
