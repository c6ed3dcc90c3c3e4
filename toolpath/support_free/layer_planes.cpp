#include "toolpath/support_free/layer_planes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr double kSpare = 0.02;  // of the limits of a layer's height, for the facets of the mesh
constexpr std::size_t kMostLayers = 100000;
// Directions no farther apart are one: the facets of a mesh turn the planes of a straight piece by less, and
// near an upright tool a machine's turning axes would leap after them.
constexpr double kSameDirection = 0.25 * kDegree;

/// Along `direction` from p to the plane.
double reach(const Vec3& p, const Vec3& direction, const SectionFrame& plane) {
  const Vec3 n = plane.normal();
  return (plane.origin - p).dot(n) / direction.dot(n);
}

class LayerStack {
 public:
  LayerStack(const geometry::Mesh& part, const StructuralLine& line, const LayerRange& range)
      : part_(part), line_(line), range_(range) {}

  std::vector<CurvedLayer> build(const Progress& progress) {
    foot_.origin = line_.at(0);
    double s = 0;
    // The last layer may stand out by half its height.
    while (s + 0.5 * range_.layer <= line_.length()) {
      s = add(s);
      if (progress) progress(std::min(1.0, s / line_.length()), "cutting layers");
      if (layers_.size() > kMostLayers)
        throw InputError(
            fmt::format("the part has more than {} layers of {:g} mm", kMostLayers, to_mm(range_.layer)));
    }
    if (layers_.empty())
      throw InputError(fmt::format("the structural line is {:g} mm long, less than half a layer of {:g} mm",
                                   to_mm(line_.length()), to_mm(range_.layer)));
    return std::move(layers_);
  }

 private:
  const SectionFrame& below() const { return layers_.empty() ? foot_ : layers_.back().top; }

  /// The height along the line and the turn [rad] of the next plane.
  struct Step {
    double height, turn;
  };

  /// As far towards the plane across the line as the section's radius allows.
  Step step_from(double s, double radius) const {
    // Where the layers wanted cannot turn far enough, those in the middle of the range turn the farthest.
    const double thin = (1 + kSpare) * range_.thinnest, thick = (1 - kSpare) * range_.thickest;
    const double wanted = std::clamp(range_.layer, thin, thick),
                 other = std::min(wanted, std::max(thin, 0.5 * (thin + thick)));
    Step best{wanted, 0};
    double best_missing = 1e9;
    for (const double height : {wanted, other}) {
      const double needed = between(below().normal(), wanted_normal(s + height)),
                   most = std::min(thick - height, height - thin) / radius;
      const double missing = (needed - most) / height;
      if (missing <= 0) return {height, needed};
      if (missing < best_missing) best = {height, std::max(0.0, most)}, best_missing = missing;
    }
    return best;
  }

  static double between(const Vec3& a, const Vec3& b) { return std::acos(std::clamp(a.dot(b), -1.0, 1.0)); }

  /// Of the plane across the line, as far as it differs from that of the layer below and from a level one.
  Vec3 wanted_normal(double s) const {
    const Vec3 across = line_.tangent(std::min(s, line_.length()));
    if (between(across, below().normal()) < kSameDirection) return below().normal();
    return between(across, Vec3::UnitZ()) < kSameDirection ? Vec3(Vec3::UnitZ()) : across;
  }

  double add(double s) {
    const double radius = layers_.empty() ? foot_radius() : layers_.back().section.radius;
    const Step step = step_from(s, radius);
    const double top = s + step.height;
    const Vec3 normal = below().normal(), wanted = wanted_normal(top);
    const Vec3 turned =
        between(normal, wanted) <= step.turn ? wanted : turned_towards(normal, wanted, step.turn);
    CurvedLayer layer;
    layer.bottom = below();
    layer.at = top;
    layer.lag = between(turned, wanted);
    if (layer.lag > range_.lag)
      throw InputError(fmt::format(
          "layer {} at {}: it leans by {:.1f} deg against the plane across the structural line, more than "
          "{:.1f} "
          "deg: the line bends too sharply for layers of {:g} to {:g} mm over a section of {:.2f} mm radius",
          layers_.size() + 1, in_mm(place(top)), to_deg(layer.lag), to_deg(range_.lag),
          to_mm(range_.thinnest), to_mm(range_.thickest), to_mm(radius)));
    layer.top = layer.bottom.carried_to(place(top), turned);
    layer.middle = layer.bottom.carried_to(place(0.5 * (s + top)), (normal + turned).normalized());
    const auto section = section_at(part_, layer.middle);
    if (!section)
      throw InputError(
          fmt::format("layer {} at {}: the part has no section there; the structural line leaves it",
                      layers_.size() + 1, in_mm(layer.middle.origin)));
    layer.section = *section;
    layers_.push_back(std::move(layer));
    return top;
  }

  /// Past its end the line goes straight on.
  Vec3 place(double s) const {
    const double end = line_.length();
    return s <= end ? line_.at(s) : Vec3(line_.at(end) + (s - end) * line_.tangent(end));
  }

  static Vec3 turned_towards(const Vec3& from, const Vec3& to, double angle) {
    const Vec3 axis = from.cross(to).normalized();
    return Eigen::AngleAxisd(angle, axis) * from;
  }

  double foot_radius() const {
    const auto section = section_at(part_, foot_.carried_to(line_.at(0.5 * range_.layer), foot_.normal()));
    if (!section)
      throw InputError(
          fmt::format("the structural line begins outside of the part, at {}", in_mm(line_.at(0))));
    return section->radius;
  }

  const geometry::Mesh& part_;
  const StructuralLine& line_;
  const LayerRange& range_;
  SectionFrame foot_;
  std::vector<CurvedLayer> layers_;
};

}  // namespace

CurvedLayer::Height CurvedLayer::over(const Vec2& q) const {
  const Vec3 p = middle.out(q), n = middle.normal();
  const double up = reach(p, n, top), down = reach(p, n, bottom);
  return {p + up * n, up - down};
}

std::vector<CurvedLayer> curved_layers(const geometry::Mesh& part, const StructuralLine& line,
                                       const LayerRange& range, const Progress& progress) {
  check_positive("layer height", to_mm(range.layer), "mm");
  check_positive("thinnest layer", to_mm(range.thinnest), "mm");
  if (!(range.thinnest <= range.layer && range.layer <= range.thickest))
    throw InputError(fmt::format("a layer of {:g} mm is outside of {:g} to {:g} mm", to_mm(range.layer),
                                 to_mm(range.thinnest), to_mm(range.thickest)));
  return LayerStack(part, line, range).build(progress);
}

}  // namespace understudy::toolpath
