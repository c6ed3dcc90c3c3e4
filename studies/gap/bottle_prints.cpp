#include "studies/gap/bottle_prints.h"

#include <algorithm>

#include "core/quantile.h"
#include "core/units.h"
#include "rehearsal/rehearse.h"

namespace understudy::studies {
namespace {

using rehearsal::Finding;
using rehearsal::TracePoint;

constexpr std::size_t kStations = 45;  // along the line: one in 0.25 mm

/// A print that a stop has cut short has no place for its points.
std::vector<GapStation> gap_along(const std::vector<BottlePrint>& runs) {
  std::vector<GapStation> along;
  for (std::size_t s = 0; s < kStations; ++s) {
    std::vector<double> here;
    for (const BottlePrint& run : runs)
      if (run.printed && run.stop.empty())
        here.push_back(run.gaps_mm[(run.gaps_mm.size() - 1) * s / (kStations - 1)]);
    if (here.empty()) return {};
    along.push_back({quantile(here, 0.05), quantile(here, 0.5), quantile(here, 0.95)});
  }
  return along;
}

}  // namespace

BottlePrint print_bottle(const GapBenchmarkRequest& request, const std::string& mode, std::uint64_t seed) {
  rehearsal::RehearsalRequest one;
  one.program = request.program;
  one.machine = request.machine;
  one.fixture = "bottle";
  one.engine = "quasistatic";
  one.gap_control = mode;
  one.seed = seed;
  one.keep_scene = one.compare_without_gap_control = false;
  const rehearsal::Record record = rehearsal::rehearse(one);
  BottlePrint run;
  run.touched =
      std::any_of(record.trace.begin(), record.trace.end(), [](const TracePoint& p) { return p.gap <= 0; }) ||
      std::any_of(record.findings.begin(), record.findings.end(),
                  [](const Finding& f) { return f.kind == "collision"; });
  int inside = 0;
  for (const TracePoint& p : record.trace) {
    if (!p.extruding) continue;
    const double gap = to_mm(p.gap);
    run.gaps_mm.push_back(gap);
    inside += gap >= record.gap_accepted_min_mm && gap <= record.gap_accepted_max_mm;
  }
  run.printed = !run.gaps_mm.empty();
  run.in_band = run.printed ? inside / static_cast<double>(run.gaps_mm.size()) : 0;
  for (const Finding& f : record.findings)
    if (f.message.starts_with("gap control stopped")) run.stop = f.message.substr(0, f.message.find(':'));
  return run;
}

BottleRow bottle_row(const std::string& mode, const std::vector<BottlePrint>& runs) {
  BottleRow row;
  row.mode = mode;
  row.in_band_worst = 1;
  std::vector<double> gaps;
  double inside = 0;
  for (const BottlePrint& run : runs) {
    ++row.machines;
    row.touched += run.touched;
    if (!run.stop.empty()) ++row.stops[run.stop];
    if (!run.printed) continue;
    ++row.printed;
    row.kept += run.in_band >= 0.99;
    row.in_band_worst = std::min(row.in_band_worst, run.in_band);
    inside += run.in_band * static_cast<double>(run.gaps_mm.size());
    gaps.insert(gaps.end(), run.gaps_mm.begin(), run.gaps_mm.end());
  }
  if (gaps.empty()) return row;
  row.in_band_fraction = inside / static_cast<double>(gaps.size());
  row.gap_p01_mm = quantile(gaps, 0.01);
  row.gap_median_mm = quantile(gaps, 0.5);
  row.gap_p99_mm = quantile(gaps, 0.99);
  row.along = gap_along(runs);
  return row;
}

}  // namespace understudy::studies
