#include "rehearsal/program/programmed_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "core/units.h"
#include "rehearsal/findings/place_text.h"
#include "rehearsal/program/programmed_areas.h"
#include "rehearsal/program/programmed_stack.h"
#include "sim/deposition/surface_gap.h"
#include "sim/strand/air_strands.h"

namespace understudy::rehearsal {
namespace {

constexpr double kPlacesPerBore = 4;
// Lines are laid as narrow as strands: what is beside a line is not taken for something that it lies on.
constexpr double kAsStrand = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-6;  // [m], of a gap: printed surfaces are known to single precision

/// A place of a stretch and what the program means at the nearest place of its lines.
struct Place {
  Vec3 tip_W;
  int first_line = 0, last_line = 0;
  double length = 0;                                          // [m]
  double distance = std::numeric_limits<double>::infinity();  // [m], of the nearest so far
  bool lies = false;                                          // there, as programmed
};

/// By their numbers.
struct Asked {
  std::size_t stretch = 0, place = 0;
};

/// Evenly, at most `spacing` [m] apart; of the bare path before it as well.
std::vector<Place> places_of(const sim::UnsupportedStretch& stretch, double spacing) {
  std::vector<Place> places;
  const auto add = [&](const Vec3& from_W, const Vec3& to_W, int first_line, int last_line) {
    const Vec3 way = to_W - from_W;
    const double count = std::max(1.0, std::ceil(way.norm() / spacing));
    for (double k = 0; k < count; ++k)
      places.push_back({from_W + (k + 0.5) / count * way, first_line, last_line, way.norm() / count});
  };
  if (stretch.bare_before.length > 0)
    add(stretch.bare_before.from_W, stretch.place_W, stretch.bare_before.line, stretch.line);
  for (std::size_t i = 1; i < stretch.path_W.size(); ++i)
    add(stretch.path_W[i - 1], stretch.path_W[i], stretch.lines[i - 1], stretch.lines[i]);
  return places;
}

/// Between these gaps [m] a line lies. One that is nearer runs over the side of a bead of its own layer.
struct Lying {
  double least = 0, most = 0;
};

void look(const ProgrammedLine& laid, const ProgrammedStack& stack, const Lying& lying, Place& place) {
  const Vec3 way = laid.to_W - laid.from_W;
  const double t = std::clamp((place.tip_W - laid.from_W).dot(way) / way.squaredNorm(), 0.0, 1.0);
  const Vec3 meant = laid.from_W + t * way;
  const double distance = (place.tip_W - meant).norm();
  if (!(distance < place.distance)) return;
  place.distance = distance;
  const double gap = stack.gap(meant, laid.R);
  place.lies = gap >= lying.least && gap <= lying.most;
}

Finding hanging_finding(const sim::UnsupportedStretch& stretch, double support) {
  Finding f;
  f.kind = "adhesion";
  f.gcode_line = stretch.line;
  f.last_line = stretch.lines.back();
  f.time_s = stretch.time;
  f.value = to_mm(std::isfinite(stretch.worst_gap) ? stretch.worst_gap : sim::kGapReach);
  f.limit = to_mm(stretch.highest_gap);
  f.unit = "mm";
  f.about = kLifted;
  const double bare = stretch.bare_before.length;
  f.message = fmt::format(
      "{} of {:.2f} mm{} hangs where the program lays it on something: gap up to {:.3f} mm, above {:.3f} mm, "
      "from {}",
      bare > 0 ? "line" : "bead", to_mm(support),
      bare > 0 ? fmt::format(", without a bead for the first {:.2f} mm,", to_mm(bare)) : "", f.value, f.limit,
      place_text(stretch.place_W));
  return f;
}

double longest_support(const std::vector<Place>& places) {
  double now = 0, longest = 0;
  for (const Place& place : places) {
    now = place.lies ? now + place.length : 0;
    longest = std::max(longest, now);
  }
  return longest;
}

}  // namespace

std::vector<double> programmed_support(const ProgrammedPrint& print,
                                       const std::vector<sim::UnsupportedStretch>& stretches) {
  std::vector<double> support(stretches.size(), 0);
  if (stretches.empty()) return support;
  std::vector<std::vector<Place>> places;
  std::unordered_map<int, std::vector<Asked>> of_line;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    places.push_back(places_of(stretches[i], print.machine.tool.nozzle_diameter / kPlacesPerBore));
    for (std::size_t k = 0; k < places[i].size(); ++k)
      for (int line = places[i][k].first_line; line <= places[i][k].last_line; ++line)
        of_line[line].push_back({i, k});
  }
  lay_program(print.program, print.machine, print.part, programmed_areas(print.program, print.machine),
              [&](const ProgrammedLine& laid, const ProgrammedStack& stack) {
                const double layer = print.layers.layer(laid.line);
                const auto asked = of_line.find(laid.line);
                if (asked != of_line.end())
                  for (const auto& [stretch, place] : asked->second)
                    look(laid, stack, {layer / 2, stretches[stretch].highest_gap + kRounding},
                         places[stretch][place]);
                return kAsStrand;
              });
  for (std::size_t i = 0; i < stretches.size(); ++i) support[i] = longest_support(places[i]);
  return support;
}

std::vector<Finding> support_findings(const ProgrammedPrint& print,
                                      const std::vector<sim::UnsupportedStretch>& loose) {
  const double reach =
      2 * print.machine.tool.nozzle_diameter;  // by a bore from what is there before and after
  std::vector<sim::UnsupportedStretch> held;
  for (const sim::UnsupportedStretch& stretch : loose)
    if ((sim::hangs_in_air(stretch) || sim::spans_a_groove(stretch)) &&
        stretch.bare_before.length + stretch.length > reach)
      held.push_back(stretch);
  const std::vector<double> support = programmed_support(print, held);
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (support[i] > reach) findings.push_back(hanging_finding(held[i], support[i]));
  return findings;
}

}  // namespace understudy::rehearsal
