#include "rehearsal/findings/accuracy_findings.h"

#include <utility>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

/// Where, and how far.
Finding at(const ErrorPeak& peak, double value, double limit, const char* unit) {
  Finding f;
  f.kind = "accuracy";
  f.gcode_line = peak.line;
  f.time_s = peak.time;
  f.value = value;
  f.limit = limit;
  f.unit = unit;
  return f;
}

std::string than_asked(const char* what, const Finding& f) {
  return fmt::format("{} by {:.3f} {} from what the program asks for, more than {:g} {}", what, f.value,
                     f.unit, f.limit, f.unit);
}

}  // namespace

std::vector<Finding> accuracy_findings(const ErrorPeak& tip, const ErrorPeak& orientation,
                                       const machine::AcceptedErrors& accepted) {
  std::vector<Finding> findings;
  const auto add = [&](Finding finding, const char* about, const char* what) {
    finding.about = about;
    finding.message = than_asked(what, finding);
    findings.push_back(std::move(finding));
  };
  if (tip.error > accepted.tip)
    add(at(tip, to_mm(tip.error), to_mm(accepted.tip), "mm"), kTip, "the tip is off");
  if (orientation.error > accepted.orientation)
    add(at(orientation, to_deg(orientation.error), to_deg(accepted.orientation), "deg"), kOrientation,
        "the tool is turned away");
  return findings;
}

}  // namespace understudy::rehearsal
