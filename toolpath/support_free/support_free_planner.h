// Layers across a part's structural line, so that nothing overhangs: the support-free method of Han 2024.
#pragma once

#include "core/progress.h"
#include "toolpath/program.h"
#include "toolpath/support_free/layer_planes.h"

namespace understudy::toolpath {

struct SupportFreePlan {
  LayerRange range;
  double bead_width = 0;               ///< [m], of a bead as high as range.layer
  int walls = 1;                       ///< contours from the outline inwards, at least 1
  double feed = 0, approach_feed = 0;  ///< [m/s]
  double clearance = 0;                ///< [m], of travel above what is printed
  double filament_diameter = 0;        ///< [m]
  double temperature = 0;              ///< [K]
  double fan = 0;                      ///< 0..1
  Progress progress = {};
};

struct SupportFreeProgram {
  Program program;
  int layers = 0;
  int travels = 0;      ///< in the air, between the first bead and the last; 0: one continuous path
  double printed = 0;   ///< [m]
  double volume = 0;    ///< [m^3]
  double tilt_max = 0;  ///< [rad], of the tool against z of W
  double lag_max = 0;   ///< [rad], of a layer against the plane across the line
  double thinnest = 0, thickest = 0;  ///< [m], of what is printed
};

/// The part stands on z = 0 of W and `line` begins at its foot. Contours of odd layers begin at one end of
/// the section's longer side, those of even layers at the other; each is closed, a zigzag between them fills
/// the section and ends where the next layer begins (Han 2024, 3.2). The tool stands across the
/// layer, its tip on the layer's top; beads are as thick as the layer at their place. Throws InputError for
/// values out of range, an open part, and as curved_layers() does; for a part of which the layers hold less
/// than `kLeastCovered`, and where a layer stands over the edge of the one below by more than a bead's width.
SupportFreeProgram plan_support_free(const geometry::Mesh& part, const StructuralLine& line,
                                     const SupportFreePlan& plan);

constexpr double kLeastCovered = 0.9;  ///< of the part's volume

}  // namespace understudy::toolpath
