// How far the surface as printed lies from the one intended, point by point.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/frames.h"
#include "geometry/mesh.h"
#include "sim/beads/bead_index.h"

namespace understudy::sim {

struct DeviationSettings {
  int samples = 20000;  ///< on the whole intended surface, or on its part in `region`
  std::uint64_t seed = 1;
  double limit = 1e-3;                          ///< [m], material farther away does not belong to a point
  std::optional<Eigen::AlignedBox3d> region_W;  ///< none: everywhere
};

struct DeviationSample {
  Vec3 place_W{0, 0, 0}, normal_W{0, 0, 1};  ///< of the intended surface, outward
  std::optional<double> along;    ///< [m], to the first bead from outside along the normal, outward positive
  std::optional<double> nearest;  ///< [m], to the nearest bead's surface; negative: inside a bead
};

/// Points spread evenly by area, equal for equal seeds. A sample's ray starts `limit` outside the surface, or
/// halfway to where the intended part faces itself, and ends `limit` inside. A point with no material within
/// the limit has no distance. Beads are what counts: neither table nor insert is the part. Throws InputError:
/// a count, limit or region out of range, a region without intended surface.
std::vector<DeviationSample> sample_deviation(const BeadIndex& beads, const geometry::Mesh& intended,
                                              const DeviationSettings& settings = {});

/// Over the samples' distances along the normal; percentiles and largest of their magnitudes. [m]
struct SurfaceDeviation {
  std::size_t samples = 0, covered = 0;
  double coverage = 0;  ///< share of the intended surface that has material within the limit
  double mean = 0;      ///< outward positive; 0 where nothing is covered, as the others
  double p50 = 0, p95 = 0, largest = 0;
  double nearest_p95 = 0;  ///< of the magnitudes of the nearest distances
};
SurfaceDeviation summarise(const std::vector<DeviationSample>& samples);

}  // namespace understudy::sim
