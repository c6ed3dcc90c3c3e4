#include "cli/urdf_of.h"

#include <vector>

#include "core/error.h"
#include "machine/file/beside_machine.h"
#include "machine/file/urdf_corrected.h"
#include "machine/file/urdf_section.h"
#include "machine/file/urdf_writer.h"

namespace understudy::cli {

std::string urdf_of(const machine::MachineDescription& machine) {
  if (!machine.is_chain())
    throw InputError(
        machine.name +
        ": URDF holds open chains only, and the struts of a hexapod close loops; see export mjcf");
  const auto& chain = machine.chain().kinematics.chain;
  if (!chain.rods.empty())
    throw InputError(
        machine.name +
        ": URDF holds open chains only, and rods that carry the tool close loops; see export mjcf");
  std::vector<machine::LinkMass> links;
  std::vector<machine::AxisDrive> drives;
  for (std::size_t i = 0; i < chain.axes.size(); ++i) {
    const machine::Link& link = machine.chain().links[i];
    links.push_back({chain.axes[i].name, static_cast<int>(i), link.mass, link.centre_O, link.inertia_O});
    drives.push_back({machine.drives[i].velocity_max, kinematics::kEndless});
  }
  return machine::write_urdf(machine.name, chain, links, drives);
}

std::string calibrated_urdf_of(const machine::MachineDescription& machine) {
  const std::string text = machine::machine_file_text(machine.file);
  const std::string urdf = machine::urdf_named_in(text, machine.file);
  if (urdf.empty()) return urdf_of(machine);
  return machine::corrected_urdf(machine, std::filesystem::absolute(machine.file).parent_path() / urdf,
                                 machine::tool_link_named_in(text, machine.file));
}

}  // namespace understudy::cli
