#include "report/study/sweep_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "report/json_text.h"
#include "studies/campaign/intervals.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using regression::SweepRow;

constexpr double kLevel = 0.95;

/// JSON has no number for what is not finite.
void put(Json& object, const char* key, double value) {
  if (std::isfinite(value)) object[key] = value;
}

Json machine_value(const SweepRow& row) {
  Json value{{"seed", row.seed}, {"verdict", row.go ? "go" : "no-go"}, {"printed", row.printed}};
  put(value, "open_loop_start_mm", row.open_loop_start_mm);
  value["open_loop_touched"] = row.open_loop_touched;
  put(value, "open_loop_in_band_fraction", row.open_loop_in_band_fraction);
  if (!row.printed) return value;
  put(value, "start_mm", row.start_mm);
  put(value, "approach_min_mm", row.approach_min_mm);
  value["touched"] = row.touched;
  put(value, "in_band_fraction", row.in_band_fraction);
  return value;
}

}  // namespace

std::string sweep_json(const std::vector<SweepRow>& rows, double accepted_min_mm, double accepted_max_mm) {
  const auto go = std::ranges::count_if(rows, [](const SweepRow& row) { return row.go; });
  const studies::Interval share =
      studies::binomial_interval(static_cast<std::uint64_t>(go), rows.size(), kLevel);
  Json document{{"schema", "understudy.sweep/1"},
                {"machines", rows.size()},
                {"go",
                 {{"count", go},
                  {"fraction", share.value},
                  {"level", kLevel},
                  {"low", share.low},
                  {"high", share.high}}},
                {"accepted_gap_mm", {{"min", accepted_min_mm}, {"max", accepted_max_mm}}},
                {"runs", Json::array()}};
  for (const SweepRow& row : rows) document["runs"].push_back(machine_value(row));
  return to_text(document, 2) + "\n";
}

}  // namespace understudy::report
