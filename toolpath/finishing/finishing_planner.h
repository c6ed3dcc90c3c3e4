// A path that mills a printed part down to its own surface, layer by layer (Yu 2023, 3.2).
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh.h"
#include "toolpath/finishing/tool_rings.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

struct FinishingPlan {
  double depth = 0;                    ///< [m], by which the printed stock is larger than the part
  double mill_radius = 0;              ///< [m]
  std::vector<ToolRing> rings;         ///< the rest of the tool
  double pitch = 0;                    ///< [m], from layer to layer, below two mill radii
  double from = 0, to = 0;             ///< [m], z of the lowest and the highest layer
  double step = 0;                     ///< [m], along an outline
  double fit_reach = 0;                ///< [m], of the points that the normal is fitted to
  double feed = 0, approach_feed = 0;  ///< [m/s]
  double clearance = 0;                ///< [m], outside of the stock
  Vec3 first_axis = -Vec3::UnitX();    ///< of the tool at home: the first outline begins where it fits
  Progress progress = {};
};

struct FinishingProgram {
  Program program;
  int layers = 0, outlines = 0;
  int left_out = 0;     ///< places of outlines where the mill cannot stand deep enough to cut
  double length = 0;    ///< [m], of cutting
  double lift_max = 0;  ///< [m], off the surface, where the part is hollow and the face would cut into it
  double fit_deviation = 0;  ///< [rad], of fitted normals from those of the mesh, at most
};

/// The tool's axis is the outward normal and its face touches the part (Yu 2023: the end mill cuts by the
/// depth along the normal), but for `lift`: in hollows it stands as far out as its face needs not to cut
/// into the part. Layers from top to bottom; each outline is closed. In between the tool goes out along its
/// axis by `clearance`, and over the part where the next place is not beside.
/// `stock` is the part as printed, `table` what it stands on. Throws InputError for values out of range, an
/// open part, a plan without a cut, and where the rest of the tool would touch stock or table: with place and
/// how deep.
FinishingProgram plan_finishing(const geometry::Mesh& part, const geometry::Mesh& stock,
                                const geometry::Mesh& table, const FinishingPlan& plan);

}  // namespace understudy::toolpath
