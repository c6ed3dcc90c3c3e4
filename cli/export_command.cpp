#include <memory>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/machine_option.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "machine/file/urdf_writer.h"

namespace understudy::cli {
namespace {

struct UrdfRequest {
  std::string machine, output;
};

int export_urdf(const UrdfRequest& r) {
  check_writable(r.output);
  const auto machine = machine::load_machine(r.machine);
  if (!machine.is_chain())
    throw InputError(
        machine.name +
        ": URDF holds open chains only, and the struts of a hexapod close loops; see export mjcf");
  const auto& chain = machine.chain().kinematics.chain;
  std::vector<machine::LinkMass> links;
  std::vector<machine::AxisDrive> drives;
  for (std::size_t i = 0; i < chain.axes.size(); ++i) {
    const machine::Link& link = machine.chain().links[i];
    links.push_back({chain.axes[i].name, static_cast<int>(i), link.mass, link.centre_O, link.inertia_O});
    drives.push_back({machine.drives[i].velocity_max, kinematics::kEndless});
  }
  write_file(r.output, machine::write_urdf(machine.name, chain, links, drives));
  fmt::print("{}\n", r.output);
  return kGood;
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("export", "Write a machine's model for other programs");
  command->require_subcommand(1);
  auto request = std::make_shared<UrdfRequest>();
  add_export_mjcf(*command, action);
  auto* urdf =
      command->add_subcommand("urdf", "URDF of an open chain: links \"work\" and \"tool\" at its ends");
  add_machine_option(*urdf, request->machine)->required();
  urdf->add_option("-o,--output", request->output, "file to write")->required();
  urdf->callback([=, &action] { action = [=] { return export_urdf(*request); }; });
}

}  // namespace understudy::cli
