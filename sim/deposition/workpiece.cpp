#include "sim/deposition/workpiece.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace understudy::sim {
namespace {

// [m]: air that separates nothing. A bead's chord over a bottle's curve leaves some micrometres, rounding
// less than one; a layer is ten times as high.
constexpr double kSlack = 20e-6;
constexpr double kBeyondTies = 1e-8;  // [m]: beads that answer alike do so within 2 nm
constexpr double kRounding = 1e-9;    // [m], by which a further step up must lead on

using Body = Workpiece::Body;
using Hit = Workpiece::Hit;

Hit of_bead(const BeadIndex::Hit& hit) {
  return {Body::bead, hit.distance, hit.place_W, hit.normal_W, hit.bead};
}

void keep_nearer(std::optional<Hit>& best, const Hit& other) {
  if (!best || other.distance < best->distance) best = other;
}

void require_finite(bool finite) {
  if (!finite) throw MachineError("the workpiece is asked for at a place that is not finite");
}

}  // namespace

Workpiece::Workpiece(std::shared_ptr<const geometry::Mesh> insert, const geometry::TableSurface& table)
    : insert_(std::move(insert)), table_(table) {}

std::optional<Hit> Workpiece::ray_hit(const Vec3& origin_W, const Vec3& direction_W, double reach,
                                      std::size_t before) const {
  require_finite(origin_W.allFinite() && direction_W.allFinite());
  std::optional<Hit> best;
  if (const auto hit = beads_.ray_hit(origin_W, direction_W, reach, before)) best = of_bead(*hit);
  if (insert_) {
    if (const auto hit = insert_->ray_hit(origin_W, direction_W, reach))
      keep_nearer(best, {Body::insert, hit->distance, hit->position, hit->normal, 0});
  }
  if (const auto t = table_.ray_hit(origin_W, direction_W); t && *t >= 0 && *t <= reach) {
    const Vec3 place_W = origin_W + *t * direction_W;
    keep_nearer(best, {Body::table, *t, place_W, table_.normal(place_W.head<2>()), 0});
  }
  return best;
}

std::optional<Hit> Workpiece::nearest(const Vec3& p_W, double cutoff, std::size_t before) const {
  require_finite(p_W.allFinite());
  std::optional<Hit> best;
  if (const auto hit = beads_.nearest_surface(p_W, cutoff, before)) best = of_bead(*hit);
  if (insert_) {
    const geometry::SurfacePoint q = insert_->nearest(p_W);
    const bool inside = insert_->open_edges() == 0 && insert_->signed_distance(p_W) < 0;
    const double distance = inside ? -q.distance : q.distance;
    if (distance <= cutoff) keep_nearer(best, {Body::insert, distance, q.position, q.normal, 0});
  }
  // Its slopes are a few milliradians: the distance across is that down, to parts in a million.
  const Vec3 normal_W = table_.normal(p_W.head<2>());
  const double above = (p_W.z() - table_.z(p_W.head<2>())) * normal_W.z();
  if (above <= cutoff && table_.reaches(p_W.head<2>()))
    keep_nearer(best, {Body::table, above, p_W - above * normal_W, normal_W, 0});
  return best;
}

// Up along the axis as long as one of the bodies goes on from where another ends.
std::optional<Hit> Workpiece::top_of_heap(const Vec3& tip_W, const Vec3& axis_W, std::size_t before) const {
  std::optional<Hit> top;
  for (;;) {
    const double height = top ? -top->distance : 0;
    const Vec3 p = tip_W + height * axis_W;
    std::optional<Hit> step;  // its distance: minus the distance up from p
    if (const auto out = beads_.way_out(p, axis_W, top ? kSlack : 0, before)) {
      step = of_bead(*out);
      step->distance = -out->distance;
    }
    if (insert_) {
      const SurfaceGap part = part_gap(*insert_, p, axis_W);
      if (part.gap < 0 && std::isfinite(part.gap))
        keep_nearer(step, {Body::insert, part.gap, p - part.gap * axis_W, part.normal_W, 0});
    }
    const SurfaceGap table = table_gap(table_, p, axis_W);
    if (table.gap < 0) keep_nearer(step, {Body::table, table.gap, p - table.gap * axis_W, table.normal_W, 0});
    if (!step || (top && -step->distance <= kRounding)) return top;
    top = step;
    top->distance -= height;
  }
}

std::optional<Hit> Workpiece::below(const Pose& X_WT, std::size_t before, std::size_t likely,
                                    double reach) const {
  require_finite(X_WT.matrix().allFinite());
  const Vec3 tip = X_WT.translation(), axis = tool_axis(X_WT);
  std::optional<Hit> best;
  if (insert_) {
    const SurfaceGap part = part_gap(*insert_, tip, axis);
    if (std::isfinite(part.gap)) best = Hit{Body::insert, part.gap, tip - part.gap * axis, part.normal_W, 0};
  }
  const SurfaceGap table = table_gap(table_, tip, axis);
  if (std::isfinite(table.gap))
    keep_nearer(best, {Body::table, table.gap, tip - table.gap * axis, table.normal_W, 0});
  bool inside = best && best->distance < 0;
  if (!inside) {
    // Beads last: they are many, and what lies below the others is of no interest.
    const double deepest = best ? std::min(reach, best->distance + kBeyondTies) : reach;
    const auto hit = beads_.ray_hit(tip, -axis, deepest, before, likely);
    if (hit && (!best || hit->distance <= best->distance)) best = of_bead(*hit);
    inside = hit && hit->distance == 0;
  }
  if (inside) {
    if (const auto top = top_of_heap(tip, axis, before)) return top;
  }
  return best;
}

}  // namespace understudy::sim
