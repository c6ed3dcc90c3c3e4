// The material of a workpiece on rays along the normals of the finished part, and what a mill takes of it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "sim/removal/surface_samples.h"

namespace understudy::sim {

/// A round end mill: a cylinder about the tool's axis, its flat face at the tip.
struct EndMill {
  double radius = 0, length = 0;  ///< [m], above 0
};

/// How far rays reach below the finished surface and above it: deeper gouges and higher material are not
/// told apart. [m]
constexpr double kBelow = 3e-3, kAbove = 6e-3;

/// Along each ray heights are exact; beside each other rays are as far apart as the samples.
class MaterialRays {
 public:
  /// The samples must outlive it. `stock` is the workpiece before: closed, in W.
  MaterialRays(const std::vector<SurfaceSample>& samples, const geometry::Mesh& stock);

  /// Takes away what is within the mill at X_WT.
  void cut(const Pose& X_WT, const EndMill& mill, int line);

  /// What a ray has left.
  struct Left {
    double before =
        0;           ///< [m], top of the stock above the finished surface; below it -kBelow: nothing is there
    double top = 0;  ///< [m], of what is left
    double deepest = 0;  ///< [m], at or below 0: how far below the surface the mill took material
    double removed = 0;  ///< [m], length of the ray that was taken
    int line = 0;        ///< of the cut that was the deepest; 0: none went below
  };
  Left left(std::size_t sample) const;

 private:
  struct Interval {
    float from, to;  // [m]
  };
  struct Ray {
    std::vector<Interval> material;  // from low to high
    float before = 0, deepest = 0, removed = 0;
    int line = 0;
  };
  void take(Ray& ray, float from, float to, int line);

  const std::vector<SurfaceSample>& samples_;
  std::vector<Ray> rays_;
  // Samples by cells of a grid over the part.
  std::size_t cell(const Eigen::Vector3i& at) const;
  Eigen::Vector3i cell_of(const Vec3& p) const;
  Vec3 origin_{0, 0, 0};
  Eigen::Vector3i size_{1, 1, 1};
  double side_ = 0;                   // [m]
  std::vector<std::uint32_t> first_;  // of each cell, in numbers_
  std::vector<std::uint32_t> numbers_;
};

}  // namespace understudy::sim
