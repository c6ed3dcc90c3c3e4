#include "toolpath/planners/planar_slicer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/planners/contour_offset.h"
#include "toolpath/planners/mesh_section.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kCollinear = 1 * kMicrometre;
constexpr int kMostLayers = 100000;
constexpr double kOnTable = 1 * kMicrometre;  // single precision of an STL

int layer_count(const geometry::Mesh& part, const PlanarPlan& plan) {
  // The last layer may stand out by half its height: then the plane through its middle still cuts the part.
  const double layers = (part.upper().z() - part.lower().z()) / plan.layer_height;
  if (!(layers >= 0.5))
    throw InputError(fmt::format("the part is {:g} mm high, less than half a layer of {:g} mm",
                                 to_mm(part.upper().z() - part.lower().z()), to_mm(plan.layer_height)));
  if (layers > kMostLayers)
    throw InputError(fmt::format("the part has {:.0f} layers of {:g} mm, more than {}", layers,
                                 to_mm(plan.layer_height), kMostLayers));
  return static_cast<int>(std::floor(layers + 0.5 - 1e-9));
}

void check(const geometry::Mesh& part, const geometry::Mesh* core, const PlanarPlan& plan) {
  check_positive("layer height", to_mm(plan.layer_height), "mm");
  check_bead(plan.bead_width, plan.layer_height);
  check_within("number of walls", plan.walls, 0, 10000, "walls");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("nozzle's flat", to_mm(plan.nozzle_flat), "mm");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_nozzle(plan.temperature, plan.fan);
  if (part.open_edges() > 0)
    throw InputError(
        fmt::format("the part has {} open edges, a part to slice must have 0", part.open_edges()));
  if (core && core->open_edges() > 0)
    throw InputError(fmt::format("the core has {} open edges, it must have 0", core->open_edges()));
  if (part.lower().z() < -kOnTable)
    throw InputError(
        fmt::format("the part reaches {:.3f} mm under the table, lower than 0 mm", -to_mm(part.lower().z())));
}

std::vector<Contour> contours_at(const geometry::Mesh& part, double z) {
  std::vector<Contour> contours;
  for (const SectionLine& line : section_lines(part, z * Vec3::UnitZ(), Vec3::UnitZ())) {
    if (!line.closed()) continue;
    Contour contour;
    for (const Vec3& p : line.points) contour.push_back(p.head<2>());
    contour = simplified(contour, kCollinear);
    if (contour.size() >= 3) contours.push_back(std::move(contour));
  }
  return contours;
}

class PlanarPrint {
 public:
  PlanarPrint(const geometry::Mesh* core, const PlanarPlan& plan)
      : core_(core), plan_(plan), builder_(plan.filament_diameter) {
    area_ = bead_area(plan.bead_width, plan.layer_height);
    pitch_ = plan.pitch > 0 ? plan.pitch : area_ / plan.layer_height;
  }

  void add_layer(const std::vector<Contour>& contours, double z_middle) {
    const double z = z_middle + 0.5 * plan_.layer_height;
    const auto wanted = [&](const Vec2& p) { return !core_ || misses_core(Vec3(p.x(), p.y(), z), z_middle); };
    bool any = false;
    for (int wall = 0; plan_.walls == 0 || wall < plan_.walls; ++wall) {
      const double offset = (0.5 + wall) * pitch_;
      // Until no wall fits: with a core, an outer one may lie inside it where an inner one does not.
      if (inset_paths(contours, offset, 0, [](const Vec2&) { return true; }).empty()) break;
      for (const FlatPath& path : inset_paths(contours, offset, plan_.bead_width, wanted)) {
        add_stroke(path, z);
        any = true;
      }
    }
    if (any) ++result_.layers;
  }

  PlanarProgram finish() {
    if (result_.strokes == 0)
      throw InputError(fmt::format("no layer of {:g} mm has room for a bead of {:g} mm",
                                   to_mm(plan_.layer_height), to_mm(plan_.bead_width)));
    builder_.travel(lifted(builder_.tool()));
    result_.program = builder_.take();
    return std::move(result_);
  }

 private:
  bool misses_core(const Vec3& tip, double z_middle) const {
    if (core_->signed_distance(Vec3(tip.x(), tip.y(), z_middle)) < 0) return false;
    // On a slope the flat's rim comes down to the core before the tip does.
    const auto below = core_->nearest(tip);
    const double across = std::sqrt(std::max(0.0, 1 - below.normal.z() * below.normal.z()));
    return below.normal.z() <= 0 || below.distance >= 0.5 * plan_.nozzle_flat * across;
  }

  static Pose upright(const Vec2& p, double z) { return tool_at(Vec3(p.x(), p.y(), z), Vec3::UnitZ()); }
  Pose lifted(Pose X_WT) const {
    X_WT.translation().z() += plan_.clearance;
    return X_WT;
  }

  void add_stroke(const FlatPath& path, double z) {
    come_to(upright(path.front(), z));
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double length = (path[i] - path[i - 1]).norm();
      if (length < kCollinear) continue;
      builder_.print(upright(path[i], z), plan_.feed, area_ * length);
      result_.printed += length;
    }
    ++result_.strokes;
  }

  void come_to(const Pose& start) {
    if (builder_.empty()) {
      builder_.begin(lifted(start), plan_.temperature, plan_.fan);
    } else {
      const Vec3 displacement = start.translation() - builder_.tool().translation();
      // To the neighbouring loop: over the bead just laid, no higher than the tip.
      if (std::abs(displacement.z()) < kCollinear && displacement.norm() < 2 * plan_.bead_width)
        return builder_.move(start, plan_.feed);
      Pose up = builder_.tool();
      up.translation().z() = lifted(start).translation().z();
      builder_.travel(up);
    }
    builder_.travel(lifted(start));
    builder_.move(start, plan_.approach_feed);
  }

  const geometry::Mesh* core_;
  PlanarPlan plan_;
  ProgramBuilder builder_;
  PlanarProgram result_;
  double area_ = 0, pitch_ = 0;  // [m^2], [m]
};

}  // namespace

PlanarProgram plan_planar(const geometry::Mesh& part, const geometry::Mesh* core, const PlanarPlan& plan) {
  check(part, core, plan);
  PlanarPrint print(core, plan);
  const int layers = layer_count(part, plan);
  for (int k = 0; k < layers; ++k) {
    const double z_middle = part.lower().z() + (k + 0.5) * plan.layer_height;
    const std::vector<Contour> contours = contours_at(part, z_middle);
    if (!contours.empty()) print.add_layer(contours, z_middle);
    tell(plan.progress, static_cast<std::size_t>(k + 1), static_cast<std::size_t>(layers), "layers");
  }
  return print.finish();
}

}  // namespace understudy::toolpath
