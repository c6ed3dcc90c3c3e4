// Planes across a structural line, between which layers lie.
#pragma once

#include <vector>

#include "core/progress.h"
#include "toolpath/support_free/flat_section.h"
#include "toolpath/support_free/structural_line.h"

namespace understudy::toolpath {

struct LayerRange {
  double layer = 0;                   ///< [m], along the structural line
  double thinnest = 0, thickest = 0;  ///< [m], anywhere in a layer
  double lag = 0;                     ///< [rad], by which a layer may lean against the plane across the line
};

/// A layer lies between two planes; its outline is that of the plane in their middle.
struct CurvedLayer {
  SectionFrame bottom, middle, top;
  FlatSection section;  ///< in `middle`
  double at = 0;        ///< [m], along the line, of the top
  double lag = 0;       ///< [rad], of the top against the plane across the line

  /// Tip over a point of `middle` [m], and the height of the layer there [m].
  struct Height {
    Vec3 tip_W;
    double thickness = 0;
  };
  Height over(const Vec2& q) const;
};

/// From the foot, which is a level plane, to the end of the line. Each plane is turned towards the one across
/// the line as far as the layer stays between thinnest and thickest over its whole section; where the line
/// bends too sharply for the layers wanted, thinner ones are used, of which more fit between the two limits.
/// Throws InputError, with place and value, where a layer leans by more than `lag` against the plane across
/// the line, and where the part ends before the line does.
std::vector<CurvedLayer> curved_layers(const geometry::Mesh& part, const StructuralLine& line,
                                       const LayerRange& range, const Progress& progress = {});

}  // namespace understudy::toolpath
