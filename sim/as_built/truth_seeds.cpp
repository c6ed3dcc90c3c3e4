#include "sim/as_built/truth_seeds.h"

#include "core/assert.h"
#include "sim/as_built/as_built.h"
#include "sim/as_built/as_built_file.h"

namespace understudy::sim {

std::array<TruthGroup, kTruthGroups> all_truth_groups() {
  std::array<TruthGroup, kTruthGroups> all{};
  for (std::size_t i = 0; i < kTruthGroups; ++i) all[i] = static_cast<TruthGroup>(i);
  return all;
}

const char* to_string(TruthGroup group) {
  switch (group) {
    case TruthGroup::geometry:
      return "geometry";
    case TruthGroup::lead:
      return "lead";
    case TruthGroup::periodic:
      return "periodic";
    case TruthGroup::play:
      return "play";
    case TruthGroup::mounting:
      return "mounting";
    case TruthGroup::camera:
      return "camera";
    case TruthGroup::light:
      return "light";
    case TruthGroup::part_place:
      return "part place";
    case TruthGroup::part_shape:
      return "part shape";
    case TruthGroup::table:
      return "table";
    case TruthGroup::process:
      return "process";
    case TruthGroup::noise:
      break;
  }
  UNDERSTUDY_ASSERT(group == TruthGroup::noise, "every group has a word");
  return "noise";
}

/// Asks the draws themselves: a tolerance says little where what it spreads is 0.
std::vector<TruthGroup> drawn_truths(const machine::MachineDescription& machine, const std::string& set,
                                     const std::string& fixture) {
  const auto drawn = [&](const TruthSeeds& seeds) {
    AsBuilt built = make_as_built(machine, set, seeds, fixture);
    built.seed = 0;  // is written, too, as are the phases of waves that are not there
    if (built.part.ripple == 0) built.part.phase = 0;
    for (DriveError& drive : built.drives)
      if (drive.periodic == 0) drive.phase = 0;
    return write_as_built(built);
  };
  const std::string one = drawn(1);
  std::vector<TruthGroup> groups;
  for (const TruthGroup group : all_truth_groups()) {
    TruthSeeds seeds(1);
    seeds[group] = 2;
    if (drawn(seeds) != one) groups.push_back(group);
  }
  return groups;
}

}  // namespace understudy::sim
