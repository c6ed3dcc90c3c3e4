// Watches an end mill finish a part: what is left over, and where it gouges.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/observer.h"
#include "sim/removal/material_rays.h"
#include "sim/removal/removal_summary.h"

namespace understudy::sim {

/// The mill of a tool that does not print: its diameter, and the length of the body that begins at the tip
/// and is no wider; without one, up to the lowest other body. Throws InputError for a tool that prints.
EndMill end_mill_of(const machine::Tool& tool);
/// The name of that body; empty: there is none.
std::string cutter_of(const machine::Tool& tool);

/// A workpiece and what shall become of it; in W, both closed.
struct Workblank {
  std::shared_ptr<const geometry::Mesh> part, stock;
  EndMill mill;
  double spacing = 0.5e-3;  ///< [m], of samples of the part's surface
};

/// Tops of the material over the samples' places [m]: before and after.
struct MilledSurface {
  std::vector<SurfaceSample> samples;
  std::vector<double> before, after;
};

class RemovalObserver : public Observer {
 public:
  explicit RemovalObserver(const Workblank& blank);
  // Its rays refer to its samples.
  RemovalObserver(const RemovalObserver&) = delete;
  RemovalObserver& operator=(const RemovalObserver&) = delete;
  /// Cuts by the poses from the last snapshot to this one, 0.05 mm apart.
  void observe(const Snapshot& snapshot) override;

  RemovalSummary summary() const;

  MilledSurface surface() const;

 private:
  struct Sweep {
    MaterialRays rays;
    std::optional<Pose> last;
  };
  void sweep(const Pose& X_WT, int line, Sweep& of) const;

  EndMill mill_;
  double spacing_;
  std::vector<SurfaceSample> samples_;
  Sweep truth_, planned_;
};

/// Binary PLY in millimetres: the cells of the samples, moved out by `heights`, each vertex with its
/// `height_mm`.
std::string surface_ply(const std::vector<SurfaceSample>& samples, const std::vector<double>& heights,
                        const std::string& title);

}  // namespace understudy::sim
