// The seeds that a built world is drawn from: one for each group of truths, so that a group can be exchanged
// between two worlds while all others stay.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "machine/description.h"

namespace understudy::sim {

enum class TruthGroup {
  geometry,    ///< joints, axes, zeros: what a calibration of the machine finds
  lead,        ///< of the drives' screws
  periodic,    ///< error of the drives over a turn
  play,        ///< of all joints
  mounting,    ///< where laser and microscope sit
  camera,      ///< principal point, distortion and blur
  light,       ///< power and waist of the laser, ambient light
  part_place,  ///< where the part is clamped
  part_shape,  ///< its size and ripple
  table,       ///< its height, tilt and bow
  process,     ///< filament diameter, extruder lag, nozzle temperature
  noise,       ///< of the camera's pictures: of the run, not of the built machine
};
constexpr std::size_t kTruthGroups = 12;
std::array<TruthGroup, kTruthGroups> all_truth_groups();
const char* to_string(TruthGroup group);  ///< "part place"

class TruthSeeds {
 public:
  /// The same for every group, which is the world of that seed.
  TruthSeeds(std::uint64_t seed) { seeds_.fill(seed); }  // NOLINT(google-explicit-constructor)
  std::uint64_t& operator[](TruthGroup group) { return seeds_[static_cast<std::size_t>(group)]; }
  std::uint64_t operator[](TruthGroup group) const { return seeds_[static_cast<std::size_t>(group)]; }

 private:
  std::array<std::uint64_t, kTruthGroups> seeds_;
};

/// The groups whose seed changes a machine that is built by `set` (make_as_built()), in their order; none
/// of a file's. Throws what that throws.
std::vector<TruthGroup> drawn_truths(const machine::MachineDescription& machine, const std::string& set,
                                     const std::string& fixture = {});

}  // namespace understudy::sim
