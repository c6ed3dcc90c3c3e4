#include "report/chart/error_budget_charts.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "report/chart/svg_chart.h"
#include "report/study/error_budget_report.h"

namespace understudy::report {
namespace {

using studies::SobolIndex;

constexpr double kLeft = 96, kWide = 520, kTop = 24, kRow = 40, kBar = 12;  // [px]
constexpr double kFull = 1.2;  // of the scale: intervals of large shares go beyond 1

double place(double share) { return kLeft + kWide * std::clamp(share, 0.0, kFull) / kFull; }

void bar(SvgDrawing& drawing, double y, const SobolIndex& index, const char* colour,
         const std::string& title) {
  const double end = place(index.value), middle = y + kBar / 2;
  drawing.rect({kLeft, y}, {end - kLeft, kBar}, fmt::format("fill=\"{}\"", colour), title);
  const double low = place(index.low), high = place(index.high);
  constexpr const char* kWhisker = "stroke=\"#222\" stroke-width=\"1.3\"";
  drawing.line({low, middle}, {high, middle}, kWhisker);
  for (const double x : {low, high}) drawing.line({x, middle - 4}, {x, middle + 4}, kWhisker);
  drawing.text({std::max(end, high) + 6, middle + 4}, share_text(index.value), "start");
}

}  // namespace

std::string error_budget_chart(const studies::QuantityBudget& quantity, const studies::BudgetPlan& plan) {
  const double bottom = kTop + kRow * static_cast<double>(quantity.shares.size());
  SvgDrawing drawing(kLeft + kWide + 56, bottom + 36);
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    drawing.line({place(share), kTop}, {place(share), bottom}, "stroke=\"#d9dee2\"");
    drawing.text({place(share), bottom + 16}, fmt::format("{:.1f}", share), "middle");
  }
  drawing.text({kLeft + kWide / 2, bottom + 32}, "share of the variance", "middle");
  constexpr std::array kWords{"total: with interactions", "first: alone"};
  for (std::size_t k = 0; k < kWords.size(); ++k)
    drawing.text({kLeft + 180 * static_cast<double>(k), 14}, kWords[k], "start",
                 fmt::format("fill=\"{}\" font-weight=\"600\"", series_colour(k)));
  double y = kTop;
  for (const std::size_t g : by_total(quantity)) {
    const std::string group = to_string(plan.groups[g]);
    drawing.text({kLeft - 8, y + kRow / 2 + 4}, group, "end");
    bar(drawing, y + 6, quantity.shares[g].total, series_colour(0), group + ", total");
    bar(drawing, y + 8 + kBar, quantity.shares[g].first, series_colour(1), group + ", first");
    y += kRow;
  }
  return drawing.finish();
}

}  // namespace understudy::report
