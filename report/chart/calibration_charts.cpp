#include "report/chart/calibration_charts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/distributions.h"
#include "core/units.h"
#include "report/chart/svg_chart.h"

namespace understudy::report {
namespace {

using namespace calibration;

/// Symmetric about 0, with room.
double span_of(const std::vector<double>& values, double least) {
  double largest = least;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return 1.08 * largest;
}

/// Pale to deep, through blue.
std::string heat(double share) {
  constexpr std::array<double, 3> kLow{232, 241, 248}, kHigh{8, 48, 107};
  const double t = std::clamp(share, 0.0, 1.0);
  std::array<int, 3> c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<int>(std::lround(kLow[i] + t * (kHigh[i] - kLow[i])));
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}  // namespace

std::vector<double> ordered_residuals(const MachineCalibration& result) {
  std::vector<double> values;
  for (const PoseResidual& p : result.poses)
    for (Eigen::Index i = 0; p.used && i < 6; ++i)
      if (std::isfinite(p.whitened[i])) values.push_back(p.whitened[i]);
  // A fit takes up the share of its parameters: without that, residuals would look too small.
  const double left = std::max(1, result.degrees_of_freedom);
  for (double& v : values) v *= std::sqrt(static_cast<double>(values.size()) / left);
  std::sort(values.begin(), values.end());
  return values;
}

std::string pose_chart(const MachineCalibration& result) {
  std::vector<double> all;
  for (const PoseResidual& p : result.poses)
    for (Eigen::Index i = 0; p.used && i < 3; ++i)
      if (std::isfinite(p.after[i])) all.push_back(to_um(p.after[i]));
  const double top = span_of(all, 1);
  SvgChart plot({}, Scale::linear(0, static_cast<double>(result.poses.size() + 1)), Scale::linear(-top, top));
  plot.y_axis("tip residual, µm");
  plot.x_axis("pose");
  for (int i = 0; i < 3; ++i)
    plot.key(i, series_colour(static_cast<std::size_t>(i)), std::string(1, "xyz"[i]));
  for (std::size_t j = 0; j < result.poses.size(); ++j)
    for (Eigen::Index i = 0; i < 3; ++i) {
      const PoseResidual& p = result.poses[j];
      if (!std::isfinite(p.after[i])) continue;
      // A rejected pose may be far outside: it stands at the edge, in grey.
      const double v = std::clamp(to_um(p.after[i]), -top, top);
      plot.dot({static_cast<double>(j + 1) + 0.18 * static_cast<double>(i - 1), v},
               p.used ? series_colour(static_cast<std::size_t>(i)) : "#9aa3ab",
               fmt::format("line {}, {}: {:.1f} µm{}", p.line, "xyz"[i], to_um(p.after[i]),
                           p.used ? "" : ", rejected"));
    }
  return plot.finish();
}

std::string spread_chart(const MachineCalibration& result) {
  const bool struts = !result.poses.empty() && !result.poses.front().strut.empty();
  const auto value = [&](const PoseResidual& p, std::size_t i) {
    return struts ? p.strut[i] / p.strut_sigma[i] : p.whitened[static_cast<Eigen::Index>(i)];
  };
  std::vector<double> all;
  for (const PoseResidual& p : result.poses)
    for (std::size_t i = 0; p.used && i < 6; ++i)
      if (std::isfinite(value(p, i))) all.push_back(value(p, i));
  const double top = span_of(all, 3);
  SvgChart plot({}, Scale::linear(0.4, 6.6), Scale::linear(-top, top));
  plot.y_axis("residual / stated sigma");
  for (const double side : {-2.0, 2.0})
    plot.line({{0.4, side}, {6.6, side}}, "stroke=\"#9aa3ab\" stroke-dasharray=\"4 4\"");
  constexpr const char* kCoordinates[6] = {"x", "y", "z", "turn x", "turn y", "turn z"};
  for (int i = 0; i < 6; ++i) plot.x_tick(i + 1, struts ? fmt::format("strut {}", i + 1) : kCoordinates[i]);
  const double count = static_cast<double>(std::max<std::size_t>(1, result.poses.size()));
  for (std::size_t j = 0; j < result.poses.size(); ++j)
    for (std::size_t i = 0; result.poses[j].used && i < 6; ++i)
      if (std::isfinite(value(result.poses[j], i)))
        plot.dot({static_cast<double>(i + 1) + 0.6 * (static_cast<double>(j) / count - 0.5),
                  value(result.poses[j], i)},
                 series_colour(0),
                 fmt::format("line {}: {:.2f}", result.poses[j].line, value(result.poses[j], i)));
  return plot.finish();
}

std::string quantile_chart(const MachineCalibration& result) {
  const std::vector<double> values = ordered_residuals(result);
  const double top = span_of(values, 3);
  SvgChart plot({}, Scale::linear(-3.6, 3.6), Scale::linear(-top, top));
  plot.y_axis("residual / sigma");
  plot.x_axis("quantile of a normal distribution");
  const double end = std::min(3.6, top);
  plot.line({{-end, -end}, {end, end}}, "stroke=\"#d55e00\"");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double expected =
        normal_quantile((static_cast<double>(k) + 0.5) / static_cast<double>(values.size()));
    plot.dot({std::clamp(expected, -3.6, 3.6), values[k]}, series_colour(0),
             fmt::format("{:.2f}", values[k]));
  }
  return plot.finish();
}

std::string heat_key(double top) {
  constexpr int kSteps = 40, kStep = 6;
  const double width = kSteps * kStep + 60;
  SvgDrawing drawing(width, 34, fmt::format("width:{:.0f}px", width));
  for (int i = 0; i < kSteps; ++i)
    drawing.rect({2.0 + i * kStep, 2}, {kStep + 1, 12}, fmt::format("fill=\"{}\"", heat((i + 0.5) / kSteps)));
  for (int i = 0; i <= 2; ++i)
    drawing.text({2 + 0.5 * i * kSteps * kStep, 29},
                 fmt::format("{:.3g}{}", to_um(0.5 * i * top), i == 2 ? " µm" : ""),
                 i == 0 ? "start" : "middle");
  return drawing.finish();
}

std::string slice_chart(const TipMap::Slice& slice, double top) {
  constexpr double kLeft = 58, kTop = 6, kWhole = 380;
  const double cell = std::floor(kWhole / std::max(slice.columns, slice.rows));
  const double width = cell * slice.columns, height = cell * slice.rows;
  SvgDrawing drawing(width + 70, height + 32);
  for (int row = 0; row < slice.rows; ++row)
    for (int column = 0; column < slice.columns; ++column) {
      const double sigma =
          slice.sigma[static_cast<std::size_t>(row) * static_cast<std::size_t>(slice.columns) +
                      static_cast<std::size_t>(column)];
      if (!std::isfinite(sigma)) continue;
      drawing.rect(
          {kLeft + column * cell, kTop + (slice.rows - 1 - row) * cell}, {cell, cell},
          fmt::format("fill=\"{}\"", heat(sigma / top)),
          fmt::format("{} {:.0f}, {} {:.0f} mm: {:.1f} µm", slice.u, to_mm(slice.u0 + column * slice.step),
                      slice.v, to_mm(slice.v0 + row * slice.step), to_um(sigma)));
    }
  const auto mm = [](double v) { return fmt::format("{:.0f}", std::round(to_mm(v)) + 0.0); };  // no -0
  const double below = height + 22, beside = kLeft - 6;
  drawing.text({kLeft, below}, mm(slice.u0), "start");
  drawing.text({kLeft + width / 2, below}, fmt::format("{} mm", slice.u), "middle");
  drawing.text({kLeft + width, below}, mm(slice.u0 + (slice.columns - 1) * slice.step), "end");
  drawing.text({beside, height}, mm(slice.v0), "end");
  drawing.text({beside, kTop + height / 2}, fmt::format("{} mm", slice.v), "end");
  drawing.text({beside, 18}, mm(slice.v0 + (slice.rows - 1) * slice.step), "end");
  drawing.rect({kLeft, kTop}, {width, height}, "fill=\"none\" stroke=\"#9aa3ab\"");
  return drawing.finish();
}

}  // namespace understudy::report
