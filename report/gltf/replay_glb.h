// A rehearsal as a glTF 2.0 binary file, machine, beads and motion (docs/viewers.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "report/gltf/bead_colours.h"
#include "report/page/recorded_replay.h"

namespace understudy::report {

struct GlbSettings {
  std::optional<BeadColour> colour;  ///< none: by gap where the machine has a band, else by width
  std::size_t slices = 200;          ///< equal times in which the beads appear
  double within = 10e-6;             ///< [m], by which bodies may be off the record at its instants
  double speed = 1;                  ///< so many times as fast as the run
};

struct Glb {
  std::string bytes;
  std::size_t triangles = 0, vertices = 0, keys = 0;
  std::size_t slices = 0;  ///< in which something was laid
  double slice_time = 0;   ///< [s] of the run, each
  double duration = 0;     ///< [s] of the animation, from its 0
  std::string legend;      ///< of the beads' colours
};

/// Metres, y up. Throws InputError: what the settings ask for is out of range or not in the record, the file
/// would be beyond 32-bit lengths.
Glb replay_glb(const RecordedReplay& replay, const GlbSettings& settings = {});

/// Of tinygltf, as it is loaded: "2.7.0".
std::string loaded_tinygltf();

}  // namespace understudy::report
