#include "report/page/over_time.h"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "report/page/pack.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using rehearsal::CurveStretch;
using rehearsal::RunCurves;
using rehearsal::Span;

constexpr double kTime = 1e-3;        // [s]
constexpr double kCelsius = 0.1;      // [K]
constexpr double kForce = 1e-2;       // [N] or [N m]
constexpr double kMicrometre = 1e-3;  // [mm]
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

using SpanOf = std::function<const Span&(const CurveStretch&)>;

Json column(const std::vector<double>& values, double unit) {
  return {{"unit", unit}, {"data", pack_values(values, unit)}};
}

bool any(const RunCurves& curves, const SpanOf& span) {
  for (const CurveStretch& stretch : curves.stretches)
    if (!span(stretch).empty()) return true;
  return false;
}

/// One end of each stretch's span, in the units of files: (value - zero) / scale.
std::vector<double> ends(const RunCurves& curves, const SpanOf& span, bool high, double scale = 1,
                         double zero = 0) {
  std::vector<double> values;
  for (const CurveStretch& stretch : curves.stretches) {
    const Span& s = span(stretch);
    values.push_back(s.empty() ? kMissing : (static_cast<double>(high ? s.high : s.low) - zero) / scale);
  }
  return values;
}

Json celsius(const RunCurves& curves, const SpanOf& span) {
  return {{"low", column(ends(curves, span, false, 1, kCelsiusZero), kCelsius)},
          {"high", column(ends(curves, span, true, 1, kCelsiusZero), kCelsius)}};
}

/// Whether the engine tells what drives carry: one that does not says 0 of all.
bool any_force(const RunCurves& curves) {
  for (const CurveStretch& stretch : curves.stretches)
    for (const Span& force : stretch.force)
      if (!force.empty() && (force.low != 0 || force.high != 0)) return true;
  return false;
}

Json drives(const rehearsal::Record& record) {
  Json all = Json::array();
  for (std::size_t i = 0; i < record.axes.size(); ++i) {
    const SpanOf span = [i](const CurveStretch& stretch) -> const Span& { return stretch.force[i]; };
    Json drive;
    drive["axis"] = record.axes[i].name;
    drive["unit"] = record.axes[i].name.ends_with("_deg") ? "N m" : "N";
    drive["low"] = column(ends(record.curves, span, false), kForce);
    drive["high"] = column(ends(record.curves, span, true), kForce);
    all.push_back(std::move(drive));
  }
  return all;
}

Json flips(const RunCurves& curves) {
  std::vector<double> times;
  std::vector<std::int64_t> axes;
  for (const sim::LoadFlip& flip : curves.flips) {
    times.push_back(flip.time);
    axes.push_back(flip.axis);
  }
  return {{"count", curves.flip_count}, {"time_s", column(times, kTime)}, {"axis", pack_integers(axes)}};
}

}  // namespace

Json over_time(const rehearsal::Record& record) {
  const RunCurves& curves = record.curves;
  if (curves.stretches.empty()) return nullptr;
  std::vector<double> begins, stretch_ends;
  for (const CurveStretch& stretch : curves.stretches) {
    begins.push_back(stretch.begin);
    stretch_ends.push_back(stretch.end);
  }
  Json object;
  object["begin_s"] = column(begins, kTime);
  object["end_s"] = column(stretch_ends, kTime);
  const SpanOf nozzle = [](const CurveStretch& s) -> const Span& { return s.nozzle_temperature; };
  const SpanOf interface = [](const CurveStretch& s) -> const Span& { return s.interface_temperature; };
  const SpanOf clearance = [](const CurveStretch& s) -> const Span& { return s.nozzle_clearance; };
  if (any(curves, nozzle)) object["nozzle_c"] = celsius(curves, nozzle);
  if (any(curves, interface)) {
    object["interface_c"] = celsius(curves, interface);
    if (curves.glass_transition > 0)
      object["glass_transition_c"] =
          stable_number(curves.glass_transition - kCelsiusZero, "glass transition");
  }
  if (any(curves, clearance))
    object["nozzle_clearance_mm"] = column(ends(curves, clearance, false, kMillimetre), kMicrometre);
  if (any_force(curves)) {
    object["drives"] = drives(record);
    object["flips"] = flips(curves);
  }
  return object;
}

}  // namespace understudy::report
