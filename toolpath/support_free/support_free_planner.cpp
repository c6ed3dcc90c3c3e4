#include "toolpath/support_free/support_free_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"
#include "toolpath/support_free/zigzag.h"

namespace understudy::toolpath {
namespace {

constexpr double kOnTable = 1 * kMicrometre;  // single precision of an STL
constexpr double kShortest = 1 * kMicrometre;
constexpr double kLayersDone = 0.5;  // of the work, as progress tells it
constexpr double kOverlap = 0.15;    // of a bead, by which the ends of the filling lines reach into the wall

void check(const geometry::Mesh& part, const SupportFreePlan& plan) {
  check_bead(plan.bead_width, plan.range.layer);
  check_within("number of walls", plan.walls, 1, 1000, "walls");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_nozzle(plan.temperature, plan.fan);
  if (part.open_edges() > 0)
    throw InputError(
        fmt::format("the part has {} open edges, a part to slice must have 0", part.open_edges()));
  if (std::abs(part.lower().z()) > kOnTable)
    throw InputError(
        fmt::format("the part's lowest point is at z = {:.3f} mm, it must stand on the table at 0 mm",
                    to_mm(part.lower().z())));
}

/// Closed: from the point nearest to `first`.
FlatPath begun(const FlatPath& loop, const Vec2& first) {
  Contour points(loop.begin(), loop.end() - 1);
  const auto nearest = std::min_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
    return (a - first).norm() < (b - first).norm();
  });
  std::rotate(points.begin(), nearest, points.end());
  points.push_back(points.front());
  return points;
}

class SupportFreePrint {
 public:
  explicit SupportFreePrint(const SupportFreePlan& plan)
      : plan_(plan),
        pitch_(bead_area(plan.bead_width, plan.range.layer) / plan.range.layer),
        builder_(plan.filament_diameter) {
    result_.thinnest = plan.range.thickest;
  }

  void add(const CurvedLayer& layer) {
    layer_ = &layer;
    const Contour& outline = layer.section.contours.front();
    // Carried from layer to layer in the frames' own axes, which turn as little as can be.
    const BoundingRectangle box = bounding_rectangle(outline, along_);
    along_ = box.along;
    const Vec2 first = beginning(box);
    bool any = false;
    for (int wall = 0; wall < plan_.walls; ++wall)
      for (const FlatPath& loop : inset(0.5 + wall)) {
        stroke(begun(loop, first), pitch_);
        any = true;
      }
    std::vector<Contour> region;
    for (const FlatPath& loop : inset(plan_.walls + 0.5 - kOverlap))
      region.emplace_back(loop.begin(), loop.end() - 1);
    double spacing = pitch_;
    const Vec2 from = layer.middle.in(builder_.tool().translation());
    for (const FlatPath& path : zigzag(region, box.along, pitch_, from, spacing)) stroke(path, spacing);
    if (!any)
      throw InputError(fmt::format("layer {} at {} has no room for a bead of {:g} mm", result_.layers + 1,
                                   in_mm(layer.middle.origin), to_mm(plan_.bead_width)));
    ++result_.layers;
    result_.tilt_max = std::max(result_.tilt_max, std::acos(std::clamp(layer.top.normal().z(), -1.0, 1.0)));
    result_.lag_max = std::max(result_.lag_max, layer.lag);
  }

  SupportFreeProgram finish() {
    builder_.travel(lifted(builder_.tool()));
    result_.program = builder_.take();
    return std::move(result_);
  }

 private:
  /// On a short side of the section, on the other one than in the layer before, where the tool is.
  Vec2 beginning(const BoundingRectangle& box) const {
    const Vec2 across(-box.along.y(), box.along.x());
    const double side = result_.layers % 2 == 0 ? -0.5 : 0.5;
    const Vec2 end = box.centre + side * box.length * box.along;
    if (builder_.empty()) return end;
    const Vec2 tip = layer_->middle.in(builder_.tool().translation());
    return end + std::clamp((tip - end).dot(across), -0.5 * box.width, 0.5 * box.width) * across;
  }

  /// Loops so many beads inside the outline.
  std::vector<FlatPath> inset(double beads) const {
    std::vector<FlatPath> loops = inset_paths(layer_->section.contours, beads * pitch_, plan_.bead_width,
                                              [](const Vec2&) { return true; });
    for (FlatPath& loop : loops)
      if (loop.front() != loop.back()) loop.push_back(loop.front());
    return loops;
  }

  Pose pose(const CurvedLayer::Height& height) const { return tool_at(height.tip_W, layer_->top.normal()); }
  Pose lifted(Pose X_WT) const {
    X_WT.translation() += plan_.clearance * X_WT.linear().col(2);
    return X_WT;
  }

  CurvedLayer::Height over(const Vec2& q) {
    const CurvedLayer::Height height = layer_->over(q);
    if (height.thickness < plan_.range.thinnest || height.thickness > plan_.range.thickest)
      throw InputError(fmt::format("layer {} at {}: {:.3f} mm high, outside of {:g} to {:g} mm",
                                   result_.layers + 1, in_mm(height.tip_W), to_mm(height.thickness),
                                   to_mm(plan_.range.thinnest), to_mm(plan_.range.thickest)));
    result_.thinnest = std::min(result_.thinnest, height.thickness);
    result_.thickest = std::max(result_.thickest, height.thickness);
    return height;
  }

  void stroke(const FlatPath& path, double width) {
    CurvedLayer::Height last = over(path.front());
    come_to(pose(last));
    for (std::size_t i = 1; i < path.size(); ++i) {
      const CurvedLayer::Height next = over(path[i]);
      const double length = (next.tip_W - last.tip_W).norm();
      if (length < kShortest) continue;
      const double volume = width * 0.5 * (last.thickness + next.thickness) * length;
      builder_.print(pose(next), plan_.feed, volume);
      result_.printed += length;
      result_.volume += volume;
      last = next;
    }
  }

  void come_to(const Pose& start) {
    if (builder_.empty()) {
      builder_.begin(lifted(start), plan_.temperature, plan_.fan);
      builder_.travel(lifted(start));
      return builder_.move(start, plan_.approach_feed);
    }
    const Vec3 way = start.translation() - builder_.tool().translation();
    if (way.norm() < kShortest) return;
    if (runs_inside(builder_.tool().translation(), start.translation())) {
      // First up to this layer's top, not along the top of the one below.
      const Vec3 tip = builder_.tool().translation();
      const double up = (start.translation() - tip).dot(layer_->top.normal());
      if (up > kShortest) {
        Pose above = builder_.tool();
        above.translation() += up * layer_->top.normal();
        builder_.move(above, plan_.feed);
      }
      return builder_.move(start, plan_.feed);
    }
    ++result_.travels;
    builder_.travel(lifted(builder_.tool()));
    builder_.travel(lifted(start));
    builder_.move(start, plan_.approach_feed);
  }

  /// Over the section all the way, where nothing stands higher than the tip.
  bool runs_inside(const Vec3& from_W, const Vec3& to_W) const {
    const Vec2 a = layer_->middle.in(from_W), b = layer_->middle.in(to_W);
    const int parts = step_count((b - a).norm(), 0.5 * plan_.bead_width);
    for (int k = 0; k <= parts; ++k)
      if (!layer_->section.holds(a + (b - a) * k / parts)) return false;
    return true;
  }

  const SupportFreePlan& plan_;
  double pitch_;  // [m], between beads that fill the layer
  ProgramBuilder builder_;
  SupportFreeProgram result_;
  const CurvedLayer* layer_ = nullptr;
  Vec2 along_{1, 0};
};

double distance_to(const Contour& contour, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], way = contour[(i + 1) % contour.size()] - a;
    const double along =
        way.squaredNorm() > 0 ? std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
    least = std::min(least, (p - a - along * way).norm());
  }
  return least;
}

/// A bead whose middle has nothing below is in the air: there no line is one that the part follows.
void check_overhangs(const std::vector<CurvedLayer>& layers, double bead_width) {
  for (std::size_t k = 1; k < layers.size(); ++k) {
    const CurvedLayer &below = layers[k - 1], &layer = layers[k];
    for (const Vec2& q : layer.section.contours.front()) {
      const Vec2 under = below.middle.in(layer.middle.out(q));
      if (below.section.holds(under)) continue;
      const double over = distance_to(below.section.contours.front(), under);
      if (over > bead_width)
        throw InputError(fmt::format(
            "layer {} at {} stands {:.2f} mm over the edge of the one below, more than a bead of {:g} mm: "
            "the part follows no structural line there",
            k + 1, in_mm(layer.middle.out(q)), to_mm(over), to_mm(bead_width)));
    }
  }
}

}  // namespace

SupportFreeProgram plan_support_free(const geometry::Mesh& part, const StructuralLine& line,
                                     const SupportFreePlan& plan) {
  check(part, plan);
  const std::vector<CurvedLayer> layers =
      curved_layers(part, line, plan.range, stage_of(plan.progress, 0, kLayersDone));
  double covered = 0;
  for (const CurvedLayer& layer : layers)
    covered += layer.section.area * layer.over(layer.section.centroid).thickness;
  if (covered < kLeastCovered * part.volume())
    throw InputError(fmt::format(
        "layers across the structural line hold {:.0f} % of the part's volume, less than {:.0f} %: the part "
        "has branches, or the line does not run through all of it",
        100 * covered / part.volume(), 100 * kLeastCovered));
  check_overhangs(layers, plan.bead_width);
  SupportFreePrint print(plan);
  const Progress progress = stage_of(plan.progress, kLayersDone, 1);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    print.add(layers[k]);
    tell(progress, k + 1, layers.size(), "filling the layers");
  }
  return print.finish();
}

}  // namespace understudy::toolpath
