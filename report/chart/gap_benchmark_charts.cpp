#include "report/chart/gap_benchmark_charts.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "report/page/html_text.h"

namespace understudy::rehearsal {
namespace {

constexpr const char* kBlue = "#005b8f";
constexpr const char* kRed = "#a33b00";

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
  constexpr int kRow = 20, kLeft = 240, kWide = 640;
  std::string svg = fmt::format(
      "<section><h2>{}</h2><svg role=\"img\" viewBox=\"0 0 1060 {}\" width=\"100%\" font-size=\"12\">\n",
      html_text(title), kRow * static_cast<int>(all.size()) + 6);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int y = kRow * static_cast<int>(i);
    const double wide = kWide * all[i].value / most;
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" "
        "height=\"14\" fill=\"{}\"/><text x=\"{:.1f}\" y=\"{}\">{:.1f} {}</text>\n",
        kLeft - 8, y + 14, html_text(all[i].name), kLeft, y + 3, wide, all[i].marked ? kRed : kBlue,
        kLeft + wide + 6, y + 14, all[i].value, html_text(unit));
  }
  return svg + "</svg></section>\n";
}

constexpr double kGapLow = -0.2, kGapHigh = 0.5;  // [mm], drawn
constexpr int kPanelWide = 300, kPanelHigh = 210, kPanelLeft = 46, kPanelTop = 24, kPanelApart = 345;

double x_of(std::size_t station, std::size_t stations, int left) {
  return left + kPanelWide * static_cast<double>(station) / static_cast<double>(stations - 1);
}
double y_of(double gap_mm) {
  return kPanelTop + kPanelHigh * (kGapHigh - std::clamp(gap_mm, kGapLow, kGapHigh)) / (kGapHigh - kGapLow);
}

/// One mode: the accepted band, 5 to 95 % of the machines, their median, and the part's surface.
std::string panel(const BottleRow& row, const GapBenchmark& b, int left) {
  std::string svg = fmt::format(
      "<text x=\"{}\" y=\"14\" font-weight=\"600\">{}</text>\n<rect x=\"{}\" y=\"{:.1f}\" width=\"{}\" "
      "height=\"{:.1f}\" fill=\"#cfe6cf\"/>\n",
      left, html_text(row.mode), left, y_of(b.band_max_mm), kPanelWide,
      y_of(b.band_min_mm) - y_of(b.band_max_mm));
  for (const double mark : {-0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5})
    svg += fmt::format(
        "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"#555\">{:.1f}</text><line x1=\"{}\" "
        "x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n",
        left - 6, y_of(mark) + 4, mark, left, left + kPanelWide, y_of(mark), y_of(mark),
        mark == 0 ? "#222" : "#ddd");
  std::string upper, lower, median;
  const std::size_t n = row.along.size();
  for (std::size_t i = 0; i < n; ++i) {
    upper += fmt::format("{:.1f},{:.1f} ", x_of(i, n, left), y_of(row.along[i].p95_mm));
    median += fmt::format("{:.1f},{:.1f} ", x_of(i, n, left), y_of(row.along[i].median_mm));
    lower += fmt::format("{:.1f},{:.1f} ", x_of(n - 1 - i, n, left), y_of(row.along[n - 1 - i].p05_mm));
  }
  return svg + fmt::format(
                   "<polygon points=\"{}{}\" fill=\"{}\" fill-opacity=\"0.3\"/><polyline points=\"{}\" "
                   "fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n",
                   upper, lower, kBlue, median, kBlue);
}

std::string gap_along_path(const GapBenchmark& b) {
  std::string panels;
  int left = kPanelLeft;
  for (const BottleRow& row : b.bottle) {
    if (row.along.size() < 2) continue;
    panels += panel(row, b, left);
    left += kPanelApart;
  }
  if (panels.empty()) return "";
  return fmt::format(
             "<section><h2>Gap along the bottle's line, mm</h2><p class=\"note\">From the line's beginning "
             "to "
             "its end: median and 5 to 95 % of the machines that printed it whole. Green: accepted. Below 0 "
             "the nozzle is in the part.</p><svg role=\"img\" viewBox=\"0 0 1060 {}\" width=\"100%\" "
             "font-size=\"12\">\n",
             kPanelTop + kPanelHigh + 12) +
         panels + "</svg></section>\n";
}

}  // namespace

std::string gap_benchmark_charts(const GapBenchmark& b) {
  std::vector<Bar> kept, sigma;
  for (const BottleRow& r : b.bottle) kept.push_back({r.mode, 100 * r.in_band_fraction, r.touched > 0});
  for (const DetectorRow& r : b.detectors)
    if (r.condition == "speckle")
      sigma.push_back({r.surface + ", " + r.detector, r.sigma_um, r.detector != "centroid"});
  return gap_along_path(b) + bars("Path in the band, all machines (red: some touched)", "%", 100, kept) +
         bars("Scatter of a frame with speckle (red: Gaussian fit)", "um", 10, sigma);
}

}  // namespace understudy::rehearsal
