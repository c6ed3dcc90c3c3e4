#include "machine/file/rods_section.h"

#include "core/error.h"
#include "kinematics/chain/rods.h"

namespace understudy::machine {

void read_rods(YamlMap& root, ChainModel& model) {
  if (model.kinematics.chain.rods.empty()) return;
  root.section("rods", "the pairs of rods between the axes and the tool", [&](YamlMap& map) {
    Rods& rods = model.rods;
    rods.mass = map.quantity("pair_kg", {1e-4, 100}, "both rods of a pair, each with its joints");
    rods.radius = map.quantity("radius_mm", {0.1, 100}, "of one rod");
    rods.spacing = map.quantity("spacing_mm", {0, 1000}, "between the two rods of a pair");
    rods.tool_offset = map.quantity("tool_offset_mm", {0, 1000}, "of the joints on the tool from its middle");
    rods.carried = map.quantity("carried_kg", {1e-3, 1000}, "what hangs on the rods, tool included");
  });
}

void check_rods(const YamlMap& root, const ChainModel& model) {
  const kinematics::Chain& chain = model.kinematics.chain;
  if (chain.rods.empty()) return;
  Vec3 joint;
  if (kinematics::rods_meet(chain, model.kinematics.home, joint) != kinematics::SolveStatus::ok)
    throw InputError(root.place("geometry"), "geometry: the three rods do not meet with the axes at home");
}

}  // namespace understudy::machine
