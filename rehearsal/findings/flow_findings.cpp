#include "rehearsal/findings/flow_findings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "rehearsal/findings/place_text.h"

namespace understudy::rehearsal {
namespace {

constexpr double kTransient = 5e-3;       // [m]: as long as an extruder takes at 100 mm/s
constexpr std::size_t kToldOneByOne = 3;  // more of them are told together
constexpr double kLeastFill = 0.85, kMostFill = 1.15;
constexpr double kRealGaps = 0.5;  // of the space: the gaps are nearly as wide as a bead is high

const char* side_of(double ratio) { return ratio > 1 ? "too much" : "too little"; }

Finding at(const FlowStretch& stretch) {
  Finding f;
  f.kind = "flow";
  f.severity = Severity::warning;
  f.gcode_line = stretch.line;
  f.time_s = stretch.time;
  f.value = stretch.ratio;
  f.limit = stretch.ratio > 1 ? 1 + kFlowTolerance : 1 - kFlowTolerance;
  f.unit = "1";
  return f;
}

Finding one_stretch(const FlowStretch& stretch) {
  Finding f = at(stretch);
  f.about = side_of(stretch.ratio);
  f.message = fmt::format("over {:.2f} mm {} is laid, {:.0f} % of what is programmed, from {}",
                          to_mm(stretch.length), f.about, 100 * stretch.ratio, place_text(stretch.place_W));
  return f;
}

Finding transients(const std::vector<FlowStretch>& stretches) {
  const auto worst = std::max_element(
      stretches.begin(), stretches.end(),
      [](const FlowStretch& a, const FlowStretch& b) { return std::abs(a.amount) < std::abs(b.amount); });
  double length = 0;
  for (const FlowStretch& stretch : stretches) length += stretch.length;
  Finding f = at(*worst);
  f.gcode_line = stretches.front().line;
  f.last_line = stretches.back().line;
  f.time_s = stretches.front().time;
  f.about = "starts and ends";
  f.message = fmt::format(
      "at {} starts, ends and corners the flow lags behind: over {:.0f} mm in all it is more than {:.0f} % "
      "off; at the worst {} over {:.2f} mm on line {}, from {}",
      stretches.size(), to_mm(length), 100 * kFlowTolerance, side_of(worst->ratio), to_mm(worst->length),
      worst->line, place_text(worst->place_W));
  return f;
}

Finding of_fill(const FillFigures& fill, double value, double limit) {
  Finding f;
  f.kind = "flow";
  f.gcode_line = fill.line;
  f.time_s = fill.time;
  f.value = value;
  f.limit = limit;
  f.unit = "1";
  return f;
}

Finding feed_finding(const FillFigures& fill) {
  const bool voids = fill.factor < kLeastFill;
  Finding f = of_fill(fill, fill.factor, voids ? kLeastFill : kMostFill);
  f.severity = voids ? Severity::error : Severity::warning;
  f.about = voids ? kVoids : kOverfilled;
  f.message = fmt::format(
      "{}: what is fed is {:.0f} % of the space between them, {} than {:.0f} %, from {}",
      voids ? "neighbouring lines leave voids" : "neighbouring lines have no room for their material",
      100 * f.value, voids ? "less" : "more", 100 * f.limit, place_text(fill.place_W));
  return f;
}

Finding lag_finding(const FillFigures& fill) {
  Finding f = of_fill(fill, fill.laid, kLeastOfFed * fill.factor);
  f.severity = fill.laid < kRealGaps ? Severity::error : Severity::warning;
  f.about = kLag;
  f.message = fmt::format(
      "the extruder lags behind the speed: what is fed is {:.0f} % of the space between neighbouring lines, "
      "but over half of their length no more than {:.0f} % lies there; the rest lies at ends and corners, "
      "from {}",
      100 * fill.factor, 100 * fill.laid, place_text(fill.place_W));
  return f;
}

}  // namespace

std::vector<Finding> flow_findings(const std::vector<FlowStretch>& stretches) {
  std::vector<FlowStretch> brief;
  for (const FlowStretch& stretch : stretches)
    if (stretch.length < kTransient) brief.push_back(stretch);
  const bool together = brief.size() > kToldOneByOne;
  std::vector<Finding> findings;
  for (const FlowStretch& stretch : stretches)
    if (!together || stretch.length >= kTransient) findings.push_back(one_stretch(stretch));
  if (together) findings.push_back(transients(brief));
  return findings;
}

std::vector<Finding> fill_findings(const std::optional<FillFigures>& fill) {
  std::vector<Finding> findings;
  if (!fill) return findings;
  if (fill->factor < kLeastFill || fill->factor > kMostFill) findings.push_back(feed_finding(*fill));
  if (fill->laid < kLeastOfFed * fill->factor) findings.push_back(lag_finding(*fill));
  return findings;
}

}  // namespace understudy::rehearsal
