#include "sim/surface/surface_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kTiltMax = 30 * kDegree;  // steeper, heights across the surface shift along it by half
constexpr std::size_t kPointsMax = 1'000'000;
constexpr std::size_t kPointsMin = 16;

struct Trace {
  Vec3 along, into;
  std::size_t points = 0;
};

Trace trace_of(const ProfileLine& line) {
  const double length = (line.to_W - line.from_W).norm(), probe = line.probe_W.norm();
  if (!std::isfinite(length) || !(length > 0))
    throw InputError(fmt::format("the profile line is {:.6g} mm long, not above 0", to_mm(length)));
  if (!std::isfinite(probe) || !(probe > 0))
    throw InputError(fmt::format("the profile's probe direction has length {}, not above 0", probe));
  if (!(line.pitch > 0 && std::isfinite(line.pitch)))
    throw InputError(fmt::format("the profile's pitch is {:.6g} um, not above 0", to_um(line.pitch)));
  if (!(line.reach > 0 && std::isfinite(line.reach)))
    throw InputError(fmt::format("the profile's reach is {:.6g} mm, not above 0", to_mm(line.reach)));
  if (!(line.tip_radius >= 0 && line.tip_radius < 0.1 * line.reach))
    throw InputError(fmt::format(
        "the stylus' tip radius is {:.6g} um, not from 0 to below {:.6g} um, a tenth of the reach",
        to_um(line.tip_radius), to_um(0.1 * line.reach)));
  // A line of a whole number of pitches has its last point, whatever the rounding.
  const double points = std::floor(length / line.pitch * (1 + 1e-9)) + 1;
  if (points > static_cast<double>(kPointsMax))
    throw InputError(fmt::format("the profile of {:.6g} mm at {:.6g} um has {:.0f} points, more than {}",
                                 to_mm(length), to_um(line.pitch), points, kPointsMax));
  if (points < static_cast<double>(kPointsMin))
    throw InputError(fmt::format("the profile of {:.6g} mm at {:.6g} um has {:.0f} points, fewer than {}",
                                 to_mm(length), to_um(line.pitch), points, kPointsMin));
  Trace trace{(line.to_W - line.from_W) / length, line.probe_W / probe, static_cast<std::size_t>(points)};
  const double off = std::abs(std::asin(std::clamp(trace.along.dot(trace.into), -1.0, 1.0)));
  if (off > kTiltMax)
    throw InputError(
        fmt::format("the probe is {:.3g} deg off square to the profile line, more than {:.3g} deg",
                    to_deg(off), to_deg(kTiltMax)));
  return trace;
}

struct Contact {
  std::optional<Workpiece::Hit> hit;
  double height = 0;  // [m], of the tip over the line
};

// The stylus comes down until the first of its three points touches.
Contact touch(const Workpiece& workpiece, const ProfileLine& line, const Trace& trace, double at) {
  struct Point {
    double aside, back;  // of the tip's radius
  };
  constexpr std::array<Point, 3> kTip{
      {{0, 0}, {-0.5, 0.1339745962155614}, {0.5, 0.1339745962155614}}};  // 1 - cos 30 deg
  Contact contact;
  for (const Point& point : kTip) {
    const double along = at + point.aside * line.tip_radius;
    const Vec3 origin = line.from_W + along * trace.along - line.reach * trace.into;
    const auto hit = workpiece.ray_hit(origin, trace.into, 2 * line.reach);
    if (hit) {
      const double height = line.reach - hit->distance - point.back * line.tip_radius;
      if (!contact.hit || height > contact.height) contact = {hit, height};
    }
    if (line.tip_radius == 0) break;
  }
  return contact;
}

void require_tilt(double tilt, double at) {
  if (tilt > kTiltMax)
    throw InputError(
        fmt::format("the probe is {:.3g} deg off the surface's normal at {:.6g} mm of the profile, more "
                    "than {:.3g} deg",
                    to_deg(tilt), to_mm(at), to_deg(kTiltMax)));
}

// Each height against the intended surface, measured across it.
void remove_intended_form(const geometry::Mesh& intended, const ProfileLine& line, const Trace& trace,
                          SurfaceProfile& profile) {
  for (std::size_t i = 0; i < trace.points; ++i) {
    const double at = static_cast<double>(i) * line.pitch;
    const Vec3 origin = line.from_W + at * trace.along - line.reach * trace.into;
    const auto hit = intended.ray_hit(origin, trace.into, 2 * line.reach);
    if (!hit)
      throw InputError(
          fmt::format("the intended part is not met at {:.6g} mm of the profile, within {:.6g} mm of it",
                      to_mm(at), to_mm(line.reach)));
    const double cosine = std::clamp(-hit->normal.dot(trace.into), -1.0, 1.0);
    profile.tilt = std::max(profile.tilt, std::acos(cosine));
    require_tilt(profile.tilt, at);
    profile.heights[i] = (profile.heights[i] - (line.reach - hit->distance)) * cosine;
  }
}

void remove_straight_line(const ProfileLine& line, const Trace& trace, SurfaceProfile& profile) {
  const auto count = static_cast<double>(trace.points);
  const double middle = 0.5 * (count - 1);
  double sum = 0, moment = 0, square = 0;
  for (std::size_t i = 0; i < trace.points; ++i) {
    const double s = static_cast<double>(i) - middle;
    sum += profile.heights[i];
    moment += s * profile.heights[i];
    square += s * s;
  }
  const double mean = sum / count, rise = moment / square, slope = rise / line.pitch;
  const Vec3 surface = trace.along - slope * trace.into;
  const double sine = surface.dot(trace.into) / surface.norm();
  profile.tilt = std::abs(std::asin(std::clamp(sine, -1.0, 1.0)));
  require_tilt(profile.tilt, middle * line.pitch);
  const double cosine = std::cos(profile.tilt);
  for (std::size_t i = 0; i < trace.points; ++i)
    profile.heights[i] = (profile.heights[i] - mean - rise * (static_cast<double>(i) - middle)) * cosine;
  profile.pitch = line.pitch * surface.norm();
}

}  // namespace

Vec3 probe_into(const geometry::Mesh& intended, const Vec3& from_W, const Vec3& to_W) {
  const double length = (to_W - from_W).norm();
  if (!std::isfinite(length) || !(length > 0))
    throw InputError(fmt::format("the profile line is {:.6g} mm long, not above 0", to_mm(length)));
  const Vec3 along = (to_W - from_W) / length;
  const Vec3 normal = intended.nearest(0.5 * (from_W + to_W)).normal;
  const Vec3 square = normal - normal.dot(along) * along;
  const double tilt = std::acos(std::clamp(square.norm(), 0.0, 1.0));
  if (tilt > kTiltMax)
    throw InputError(
        fmt::format("the profile line rises {:.3g} deg out of the intended surface, more than {:.3g} deg",
                    to_deg(tilt), to_deg(kTiltMax)));
  return -square.normalized();
}

SurfaceProfile measure_profile(const Workpiece& workpiece, const geometry::Mesh* intended,
                               const ProfileLine& line) {
  const Trace trace = trace_of(line);
  SurfaceProfile profile;
  profile.pitch = line.pitch;
  profile.heights.resize(trace.points);
  for (std::size_t i = 0; i < trace.points; ++i) {
    const double at = static_cast<double>(i) * line.pitch;
    const Contact contact = touch(workpiece, line, trace, at);
    if (!contact.hit)
      throw InputError(fmt::format("the profile misses the part: nothing at {:.6g} mm of it within {:.6g} mm",
                                   to_mm(at), to_mm(line.reach)));
    if (contact.hit->body == Workpiece::Body::bead) ++profile.on_beads;
    if (contact.hit->body == Workpiece::Body::insert) ++profile.on_insert;
    if (contact.hit->body == Workpiece::Body::table) ++profile.on_table;
    profile.heights[i] = contact.height;
  }
  if (profile.on_beads == 0)
    throw InputError(
        fmt::format("the profile misses the part: of its {} points none is on a bead ({} on the insert, "
                    "{} on the table)",
                    trace.points, profile.on_insert, profile.on_table));
  if (intended)
    remove_intended_form(*intended, line, trace, profile);
  else
    remove_straight_line(line, trace, profile);
  return profile;
}

}  // namespace understudy::sim
