// The line along which a part grows, given or found from the part.
//
// Source: Han 2024, 3.1, "slicing algorithm based on structural lines"; there the line is an edge of the
// model that a person picks. Here it is the line of the section's centroids, of sections across the line
// itself.
#pragma once

#include <vector>

#include "core/progress.h"
#include "geometry/mesh.h"

namespace understudy::toolpath {

/// A smooth line through points: cubic between them, with the direction of its neighbours at each. Places are
/// lengths along it [m].
class StructuralLine {
 public:
  /// At least two points, none on its neighbour [m]. Throws InputError.
  explicit StructuralLine(std::vector<Vec3> points);

  double length() const { return starts_.back(); }
  Vec3 at(double s) const;
  Vec3 tangent(double s) const;  ///< unit
  const std::vector<Vec3>& points() const { return points_; }

 private:
  /// The piece that `s` lies on, and where on it, 0 to 1.
  std::pair<std::size_t, double> piece(double s) const;
  Vec3 slope(std::size_t i) const;

  std::vector<Vec3> points_;
  std::vector<double> starts_;  // length up to each point, along the chords
};

/// From the middle of the part's foot, where the part leaves the plane z = lower, in steps of `step` [m] to
/// its end: the smoothest line within `tolerance` [m] of the centroids of the sections across it, so that it
/// does not turn with the facets of a mesh. Throws InputError for an open part, and where the part forks, so
/// that no section continues the line.
StructuralLine find_structural_line(const geometry::Mesh& part, double step, double tolerance,
                                    const Progress& progress = {});

}  // namespace understudy::toolpath
