#include "report/chart/comparison_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.h"
#include "core/units.h"
#include "report/chart/svg_chart.h"
#include "report/trace/trace_values.h"

namespace understudy::report {
namespace {

using rehearsal::TracePoint;
using Trace = std::vector<TracePoint>;
using Pieces = std::vector<std::vector<ChartPoint>>;  ///< a curve that pauses

constexpr std::size_t kPointsMax = 2000;  ///< of a curve: four to a pixel of the plot
constexpr const char* kStrokeA = "stroke=\"#c26a00\" stroke-width=\"1.6\" stroke-dasharray=\"7 4\"";
constexpr const char* kStrokeB = "stroke=\"#0072b2\" stroke-width=\"1.4\"";

double value_of(const TracePoint& point, ComparedCurve curve) {
  return curve == ComparedCurve::gap ? to_mm(point.gap) : to_um(point.tip_error);
}

Pieces pieces_of(const Trace& trace, ComparedCurve curve, CurveAlong along) {
  Pieces pieces;
  bool drawing = false;
  for (const std::size_t i : thin_out(trace, kPointsMax)) {
    const TracePoint& point = trace[i];
    const double value = value_of(point, curve);
    if (!point.extruding || !std::isfinite(value)) {
      drawing = false;
      continue;
    }
    if (!drawing) pieces.emplace_back();
    drawing = true;
    pieces.back().push_back({along == CurveAlong::time ? point.time : to_mm(point.path), value});
  }
  return pieces;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double length() const { return high - low; }
};

/// With 0, and without spikes that would flatten the rest.
Range values_range(const std::vector<double>& values) {
  Range all{std::min(0.0, std::ranges::min(values)), std::max(0.0, std::ranges::max(values))};
  const Range most{std::min(0.0, quantile(values, 0.01)), std::max(0.0, quantile(values, 0.99))};
  const double span = most.length() > 0 ? most.length() : 1;
  all.high = std::min(all.high, most.high + 1.5 * span);
  all.low = std::max(all.low, most.low - 1.5 * span);
  const double margin = 0.06 * (all.length() > 0 ? all.length() : 1);
  return {all.low < 0 ? all.low - margin : 0, all.high + margin};
}

void draw(SvgChart& chart, const Pieces& pieces, const Range& y, const char* stroke) {
  for (std::vector<ChartPoint> piece : pieces) {
    for (ChartPoint& point : piece) point.y = std::clamp(point.y, y.low, y.high);
    chart.line(piece, stroke);
  }
}

}  // namespace

std::string comparison_chart(const Trace& a, const Trace& b, ComparedCurve curve, CurveAlong along) {
  const Pieces pieces_a = pieces_of(a, curve, along), pieces_b = pieces_of(b, curve, along);
  Range x;
  std::vector<double> values;
  for (const Pieces* pieces : {&pieces_a, &pieces_b})
    for (const std::vector<ChartPoint>& piece : *pieces)
      for (const ChartPoint& point : piece) {
        x.low = std::min(x.low, point.x);
        x.high = std::max(x.high, point.x);
        values.push_back(point.y);
      }
  if (values.empty() || !(x.length() > 0)) return "";
  const Range y = values_range(values);
  SvgChart chart({}, Scale::linear(x.low, x.high), Scale::linear(y.low, y.high));
  chart.title(curve == ComparedCurve::gap ? "Gap of A and B" : "Tip error of A and B");
  chart.y_axis(curve == ComparedCurve::gap ? "gap (mm)" : "tip error (µm)");
  chart.x_axis(along == CurveAlong::time ? "time (s)" : "path (mm)");
  draw(chart, pieces_a, y, kStrokeA);
  draw(chart, pieces_b, y, kStrokeB);
  return chart.finish();
}

std::string comparison_key(bool of_a) {
  SvgDrawing drawing(26, 8, "width:26px;height:8px");
  drawing.title(of_a ? "dashed line" : "solid line");
  drawing.line({0, 4}, {26, 4}, of_a ? kStrokeA : kStrokeB);
  return drawing.finish();
}

}  // namespace understudy::report
