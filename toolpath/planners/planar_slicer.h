// Planar layers: the part cut by level planes, the tool upright. What conformal paths are compared with.
#pragma once

#include "core/progress.h"
#include "geometry/mesh.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

struct PlanarPlan {
  double layer_height = 0;       ///< [m], of every layer, and of every bead
  double bead_width = 0;         ///< [m]
  double pitch = 0;              ///< [m], from bead to bead; 0: what their volume fills
  int walls = 0;                 ///< beads from the outline inwards; 0: until the section is full
  double feed = 0;               ///< [m/s]
  double approach_feed = 0;      ///< [m/s]
  double clearance = 0;          ///< [m], of travel above the layer
  double nozzle_flat = 0;        ///< [m], diameter of the flat ring round the bore, which must miss the core
  double filament_diameter = 0;  ///< [m]
  double temperature = 0;        ///< [K]
  double fan = 0;                ///< 0..1
  Progress progress = {};
};

struct PlanarProgram {
  Program program;
  int layers = 0;      ///< with something printed in them
  int strokes = 0;     ///< beads without a break
  double printed = 0;  ///< [m]
};

/// Cuts the closed part by planes through the middle of each layer, from its lowest point upwards, and lays
/// beads along the outline and inside it, half a bead from it; bead after bead inwards, at area / height
/// unless a pitch is given, so that a filled layer has the volume of its section. With a `core`, an object
/// that is there already, beads lie only where their middle is outside of it and the nozzle's flat misses it.
/// The tip runs at the top of the layer, the tool upright. Throws InputError for values out of range, an open
/// part or core, a part lower than a layer or under the table, or when nothing is left to print.
PlanarProgram plan_planar(const geometry::Mesh& part, const geometry::Mesh* core, const PlanarPlan& plan);

}  // namespace understudy::toolpath
