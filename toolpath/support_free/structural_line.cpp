#include "toolpath/support_free/structural_line.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/support_free/flat_section.h"
#include "toolpath/support_free/smoothed_points.h"

namespace understudy::toolpath {
namespace {

constexpr double kSamePlace = 1 * kMicrometre;
constexpr int kRefinements = 3;
constexpr double kWalked = 0.3;  // of the work, as progress tells it
constexpr std::size_t kMostPoints = 100000;
// Of a step, by which the middle of the section may move sidewards: more shows that the plane runs into the
// end of the part or into a branch. A part may lean from its foot on, until the line has found its direction.
constexpr double kMostLeap = 0.35, kMostFirstLeap = 1.5;
constexpr std::size_t kFirstSteps = 5;
constexpr double kFacets = 10 * kMicrometre;  // by which a mesh alone moves it
constexpr double kEndSteps = 3;               // from the last section to the end of the part
constexpr double kLastStep = 0.02;            // of a step, to which the end of the part is found

/// Walks up the part from its foot.
class LineFinder {
 public:
  LineFinder(const geometry::Mesh& part, double step, double tolerance, const Progress& progress)
      : part_(part), step_(step), tolerance_(tolerance), progress_(progress) {}

  StructuralLine find() {
    start();
    double step = step_;
    while (step > kLastStep * step_) {
      if (!advance(step)) step /= 2;
      tell_walk();
      if (points_.size() > kMostPoints)
        throw InputError(
            fmt::format("the structural line has more than {} points: a larger --step", kMostPoints));
    }
    end();
    for (int i = 0; i < kRefinements; ++i)
      refine(stage_of(progress_, kWalked + (1 - kWalked) * i / kRefinements,
                      kWalked + (1 - kWalked) * (i + 1) / kRefinements));
    return StructuralLine(points_);
  }

 private:
  // A straight part is as long as its box; on the way along a longer one the share stays.
  void tell_walk() const {
    const double box = (part_.upper() - part_.lower()).norm();
    const double walked = step_ * static_cast<double>(points_.size());
    if (progress_) progress_(kWalked * std::min(1.0, walked / box), "finding the part's line");
  }

  void start() {
    const double z = part_.lower().z();
    SectionFrame foot;
    // Just above the foot, whose facets lie in the plane itself.
    foot.origin = Vec3(0, 0, z + kLastStep * step_);
    const auto section = foot_at(foot);
    if (!section) throw InputError(fmt::format("the part has no foot at {}", in_mm(foot.origin)));
    foot.origin = foot.out(section->centroid);
    frame_ = foot;
    points_.push_back(Vec3(foot.origin.x(), foot.origin.y(), z));
  }

  /// The section nearest to the part's lowest vertex; moves the frame there.
  std::optional<FlatSection> foot_at(SectionFrame& frame) const {
    const auto lowest = std::ranges::min_element(part_.vertices(), {}, [](const Vec3& v) { return v.z(); });
    frame.origin.head<2>() = lowest->head<2>();
    return section_at(part_, frame);
  }

  bool advance(double step) {
    const Vec3 direction = frame_.normal();
    const SectionFrame ahead = frame_.carried_to(points_.back() + step * direction, direction);
    const auto section = section_at(part_, ahead);
    if (!section) return false;
    const Vec3 next = ahead.out(section->centroid);
    const double leap = section->centroid.norm();
    if (leap > (points_.size() < kFirstSteps ? kMostFirstLeap : kMostLeap) * step + kFacets) return false;
    const Vec3 moved = next - points_.back();
    if (moved.norm() < kSamePlace || moved.dot(direction) <= 0) return false;
    points_.push_back(next);
    // Half of the turn now, for a middle that is off by the facets of the mesh.
    frame_ = ahead.carried_to(next, (direction + moved.normalized()).normalized());
    return true;
  }

  /// To the end of the part, straight on.
  void end() {
    if ((points_.back() - points_.front()).norm() < 3 * step_)
      throw InputError(fmt::format("the part is shorter than three steps of {:g} mm", to_mm(step_)));
    const Vec3 last = points_.back(), direction = (last - point_before(2 * step_)).normalized();
    const auto hit = part_.ray_hit(last, direction, (part_.upper() - part_.lower()).norm());
    if (!hit || hit->distance < kSamePlace) return;
    if (hit->distance > kEndSteps * step_)
      throw InputError(
          fmt::format("the part forks at {}: the middle of its section leaps there, {:.1f} mm before its "
                      "end; give its line",
                      in_mm(last), to_mm(hit->distance)));
    points_.push_back(hit->position);
  }

  /// The last one that is so far from the end of the line, or its first.
  Vec3 point_before(double distance) const {
    for (auto point = points_.rbegin(); point != points_.rend(); ++point)
      if ((*point - points_.back()).norm() >= distance) return *point;
    return points_.front();
  }

  /// Sections across the line as it is by now, at its own points; its ends stay.
  void refine(const Progress& progress) {
    const StructuralLine line(even(points_));
    std::vector<Vec3> better{line.points().front()};
    SectionFrame frame;
    const int count = step_count(line.length(), step_);
    for (int i = 1; i < count; ++i) {
      tell(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(count), "smoothing the line");
      const double s = line.length() * i / count;
      frame = frame.carried_to(line.at(s), line.tangent(s));
      const auto section = section_at(part_, frame);
      // Near its ends a plane across the line may leave the part.
      better.push_back(section && section->centroid.norm() < step_ ? frame.out(section->centroid)
                                                                   : frame.origin);
    }
    better.push_back(line.points().back());
    points_ = smoothed_points(better, tolerance_);
  }

  /// Without points that came close together where the end was looked for.
  std::vector<Vec3> even(const std::vector<Vec3>& points) const {
    std::vector<Vec3> kept{points.front()};
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      if ((points[i] - kept.back()).norm() > 0.5 * step_ && (points.back() - points[i]).norm() > 0.5 * step_)
        kept.push_back(points[i]);
    kept.push_back(points.back());
    return kept;
  }

  const geometry::Mesh& part_;
  double step_, tolerance_;
  const Progress& progress_;
  SectionFrame frame_;
  std::vector<Vec3> points_;
};

}  // namespace

StructuralLine::StructuralLine(std::vector<Vec3> points) : points_(std::move(points)) {
  if (points_.size() < 2)
    throw InputError(fmt::format("a structural line of {} point, 2 are needed", points_.size()));
  starts_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const double length = (points_[i] - points_[i - 1]).norm();
    if (!(length > kSamePlace))
      throw InputError(fmt::format("point {} of the structural line lies on the one before, at {}", i + 1,
                                   in_mm(points_[i])));
    starts_.push_back(starts_.back() + length);
  }
}

std::pair<std::size_t, double> StructuralLine::piece(double s) const {
  const auto next = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, s);
  const auto i = static_cast<std::size_t>(next - starts_.begin()) - 1;
  return {i, std::clamp((s - starts_[i]) / (starts_[i + 1] - starts_[i]), 0.0, 1.0)};
}

/// d p / d s at point i: through its neighbours; at the ends, of the parabola through three points.
Vec3 StructuralLine::slope(std::size_t i) const {
  const std::size_t last = points_.size() - 1;
  if (last == 1) return (points_[1] - points_[0]) / starts_[1];
  const std::size_t middle = std::clamp<std::size_t>(i, 1, last - 1);
  const double before = starts_[middle] - starts_[middle - 1], after = starts_[middle + 1] - starts_[middle];
  const Vec3 a = (points_[middle] - points_[middle - 1]) / before,
             b = (points_[middle + 1] - points_[middle]) / after;
  if (i < middle) return a + (a - b) * before / (before + after);
  if (i > middle) return b + (b - a) * after / (before + after);
  return (a * after + b * before) / (before + after);
}

Vec3 StructuralLine::at(double s) const {
  const auto [i, t] = piece(s);
  const double h = starts_[i + 1] - starts_[i];
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * points_[i] + (t3 - 2 * t2 + t) * h * slope(i) +
         (3 * t2 - 2 * t3) * points_[i + 1] + (t3 - t2) * h * slope(i + 1);
}

Vec3 StructuralLine::tangent(double s) const {
  const auto [i, t] = piece(s);
  const double h = starts_[i + 1] - starts_[i];
  const double t2 = t * t;
  return ((6 * t2 - 6 * t) / h * (points_[i] - points_[i + 1]) + (3 * t2 - 4 * t + 1) * slope(i) +
          (3 * t2 - 2 * t) * slope(i + 1))
      .normalized();
}

StructuralLine find_structural_line(const geometry::Mesh& part, double step, double tolerance,
                                    const Progress& progress) {
  check_positive("step of the structural line", to_mm(step), "mm");
  check_within("tolerance of the structural line", to_mm(tolerance), 0, 10, "mm");
  if (part.open_edges() > 0)
    throw InputError(
        fmt::format("the part has {} open edges, a part to slice must have 0", part.open_edges()));
  return LineFinder(part, step, tolerance, progress).find();
}

}  // namespace understudy::toolpath
