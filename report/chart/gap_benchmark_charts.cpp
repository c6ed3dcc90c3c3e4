#include "report/chart/gap_benchmark_charts.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "report/chart/svg_chart.h"
#include "report/markup.h"

namespace understudy::report {
namespace {

struct Bar {
  std::string name;
  double value = 0;
  bool marked = false;
};

/// Horizontal bars with their numbers.
std::string bars(const std::string& title, const std::string& unit, double full,
                 const std::vector<Bar>& all) {
  if (all.empty()) return "";
  double most = full;
  for (const Bar& bar : all) most = std::max(most, bar.value);
  constexpr double row = 20, left = 240, widest = 640;
  SvgDrawing drawing(1060, row * static_cast<double>(all.size()) + 6);
  double y = 0;
  for (const Bar& bar : all) {
    const double wide = widest * bar.value / most;
    drawing.text({left - 8, y + 14}, bar.name, "end");
    drawing.rect({left, y + 3}, {wide, 14}, fmt::format("fill=\"{}\"", series_colour(bar.marked ? 1 : 0)));
    drawing.text({left + wide + 6, y + 14}, fmt::format("{:.1f} {}", bar.value, unit), "start");
    y += row;
  }
  return fmt::format("<section><h2>{}</h2>{}</section>\n", html_text(title), drawing.finish());
}

/// One mode: the accepted band, 5 to 95 % of the machines, their median, and the part's surface.
std::string gap_chart(const studies::BottleRow& row, const studies::GapBenchmark& b) {
  constexpr double kLow = -0.2, kHigh = 0.5;  // [mm], drawn
  const auto drawn = [&](double gap_mm) { return std::clamp(gap_mm, kLow, kHigh); };
  SvgChart chart({360, 260, 56, 16, 8, 36}, Scale::linear(0, 100), Scale::linear(kLow, kHigh));
  chart.band({{0, b.band_min_mm}, {100, b.band_min_mm}}, {{0, b.band_max_mm}, {100, b.band_max_mm}},
             series_colour(2));
  chart.y_axis("gap, mm");
  chart.x_axis("along the line, %");
  chart.line({{0, 0}, {100, 0}}, "stroke=\"#222\"");
  std::vector<ChartPoint> lower, median, upper;
  double station = 0;
  for (const studies::GapStation& at : row.along) {
    const double along = 100 * station++ / static_cast<double>(row.along.size() - 1);
    lower.push_back({along, drawn(at.p05_mm)});
    median.push_back({along, drawn(at.median_mm)});
    upper.push_back({along, drawn(at.p95_mm)});
  }
  chart.band(lower, upper, series_colour(0));
  chart.line(median, fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", series_colour(0)));
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", chart.finish(), html_text(row.mode));
}

std::string gap_along_path(const studies::GapBenchmark& b) {
  std::string charts;
  for (const studies::BottleRow& row : b.bottle)
    if (row.along.size() >= 2) charts += gap_chart(row, b);
  if (charts.empty()) return "";
  return "<section><h2>Gap along the bottle's line</h2><p class=\"note\">Median and 5 to 95 % of the "
         "machines "
         "that printed it whole. Green: accepted. Below 0 the nozzle is in the part.</p>"
         "<div class=\"pictures\">" +
         charts + "</div></section>\n";
}

}  // namespace

std::string gap_benchmark_charts(const studies::GapBenchmark& b) {
  std::vector<Bar> kept, sigma;
  for (const studies::BottleRow& r : b.bottle)
    kept.push_back({r.mode, 100 * r.in_band_fraction, r.touched > 0});
  for (const studies::DetectorRow& r : b.detectors)
    if (r.condition == "speckle")
      sigma.push_back({r.surface + ", " + r.detector, r.sigma_um, r.detector != "centroid"});
  return gap_along_path(b) + bars("Path in the band, all machines (orange: some touched)", "%", 100, kept) +
         bars("Scatter of a frame with speckle (orange: Gaussian fit)", "um", 10, sigma);
}

}  // namespace understudy::report
