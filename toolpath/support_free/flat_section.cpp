#include "toolpath/support_free/flat_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/units.h"
#include "toolpath/planners/mesh_section.h"

namespace understudy::toolpath {
namespace {

constexpr double kCollinear = 1 * kMicrometre;

/// Twice the signed area is the sum of cross products.
double signed_area(const Contour& contour) {
  double area = 0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    area += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  return area;
}

Vec2 moment(const Contour& contour) {
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    sum += (a + b) * (a.x() * b.y() - b.x() * a.y()) / 6;
  }
  return sum;
}

bool contains(const Contour& contour, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec2 &a = contour[i], &b = contour[(i + 1) % contour.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

double distance(const Contour& contour, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2& q : contour) least = std::min(least, (q - p).norm());
  return least;
}

std::vector<Contour> contours_of(const geometry::Mesh& part, const SectionFrame& frame) {
  std::vector<Contour> contours;
  for (const SectionLine& line : section_lines(part, frame.origin, frame.normal())) {
    if (!line.closed()) continue;
    Contour contour;
    for (const Vec3& p : line.points) contour.push_back(frame.in(p));
    contour = simplified(contour, kCollinear);
    if (contour.size() >= 3) contours.push_back(std::move(contour));
  }
  return contours;
}

}  // namespace

SectionFrame SectionFrame::carried_to(const Vec3& point, const Vec3& normal) const {
  const Mat3 turn = Quat::FromTwoVectors(this->normal(), normal).toRotationMatrix();
  SectionFrame frame;
  frame.origin = point;
  frame.u = turn * u;
  // Rounding does not add up over thousands of layers.
  frame.u = (frame.u - normal * normal.dot(frame.u)).normalized();
  frame.v = normal.cross(frame.u);
  return frame;
}

bool FlatSection::holds(const Vec2& q) const {
  // A hole within the outline turns the answer round.
  bool inside = false;
  for (const Contour& contour : contours) inside = inside != contains(contour, q);
  return inside;
}

std::optional<FlatSection> section_at(const geometry::Mesh& part, const SectionFrame& frame) {
  const std::vector<Contour> contours = contours_of(part, frame);
  const Contour* outline = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Contour& contour : contours) {
    const double area = signed_area(contour);
    if (area <= 0) continue;
    // Inside: the smallest of those around the point. Outside: the nearest, if it is near.
    const double away = contains(contour, Vec2::Zero()) ? 0 : distance(contour, Vec2::Zero());
    if (away > 2 * std::sqrt(area / std::numbers::pi)) continue;
    const double rank = away > 0 ? 1 + away : area;
    if (rank < least) least = rank, outline = &contour;
  }
  if (outline == nullptr) return std::nullopt;
  FlatSection section;
  section.contours.push_back(*outline);
  for (const Contour& contour : contours)
    if (signed_area(contour) < 0 && contains(*outline, contour.front())) section.contours.push_back(contour);
  Vec2 sum = Vec2::Zero();
  for (const Contour& contour : section.contours) {
    section.area += signed_area(contour);
    sum += moment(contour);
  }
  if (!(section.area > 0)) return std::nullopt;
  section.centroid = sum / section.area;
  for (const Vec2& p : *outline) section.radius = std::max(section.radius, p.norm());
  return section;
}

}  // namespace understudy::toolpath
