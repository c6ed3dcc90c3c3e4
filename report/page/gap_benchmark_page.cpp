#include "report/page/gap_benchmark_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/version.h"
#include "report/chart/gap_benchmark_charts.h"
#include "report/json_text.h"
#include "report/markup.h"
#include "report/page/faulted_twin_tables.h"
#include "report/page/page_parts.h"
#include "report/page/word_table.h"

namespace understudy::report {
namespace {

using studies::ApproachRow;
using studies::BottleRow;
using studies::DetectorRow;
using studies::FollowingRow;
using studies::GapBenchmark;
using studies::GapStation;
using studies::Spread;
using Json = nlohmann::ordered_json;

Json number(double value) { return stable_number(value, "gap benchmark"); }
Json spread_value(const Spread& spread) {
  return {{"median", number(spread.median)}, {"p95", number(spread.p95)}};
}

Json detectors_value(const GapBenchmark& b) {
  Json rows = Json::array();
  for (const DetectorRow& r : b.detectors) {
    Json row{{"surface", r.surface},
             {"condition", r.condition},
             {"detector", r.detector},
             {"frames", r.frames},
             {"missed", r.missed}};
    if (r.frames > r.missed) {
      row["bias_um"] = number(r.bias_um);
      row["sigma_um"] = number(r.sigma_um);
      row["p95_um"] = number(r.p95_um);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json approaches_value(const GapBenchmark& b) {
  Json rows = Json::array();
  for (const ApproachRow& r : b.approaches) {
    Json row{{"surface", r.surface}, {"condition", r.condition},    {"benign", r.benign},
             {"runs", r.runs},       {"reached", r.reached},        {"touches", r.touches},
             {"stops", r.stops},     {"false_stops", r.false_stops}};
    if (r.reached > 0) {
      row["error_um"] = spread_value(r.error_um);
      row["settle_s"] = spread_value(r.settle_s);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json followings_value(const GapBenchmark& b) {
  Json rows = Json::array();
  for (const FollowingRow& r : b.followings) {
    Json row{{"surface", r.surface}, {"condition", r.condition},    {"benign", r.benign},
             {"runs", r.runs},       {"completed", r.completed},    {"touches", r.touches},
             {"stops", r.stops},     {"false_stops", r.false_stops}};
    if (r.in_band_fraction > 0) {
      row["in_band_fraction"] = number(r.in_band_fraction);
      row["error_um"] = spread_value(r.error_um);
      row["followed_fraction"] = number(r.followed_fraction);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Columns, from the line's beginning to its end.
Json along_value(const std::vector<GapStation>& along) {
  Json low = Json::array(), median = Json::array(), high = Json::array();
  for (const GapStation& station : along) {
    low.push_back(number(station.p05_mm));
    median.push_back(number(station.median_mm));
    high.push_back(number(station.p95_mm));
  }
  return {{"p05_mm", low}, {"median_mm", median}, {"p95_mm", high}};
}

Json bottle_value(const GapBenchmark& b) {
  Json rows = Json::array();
  for (const BottleRow& r : b.bottle) {
    Json row{{"gap_control", r.mode}, {"machines", r.machines}, {"printed", r.printed},
             {"touched", r.touched},  {"kept", r.kept},         {"stops", r.stops}};
    if (r.printed > 0) {
      row["in_band_fraction"] = number(r.in_band_fraction);
      row["in_band_worst"] = number(r.in_band_worst);
      row["gap_mm"] = {
          {"p01", number(r.gap_p01_mm)}, {"median", number(r.gap_median_mm)}, {"p99", number(r.gap_p99_mm)}};
      row["along"] = along_value(r.along);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string stops_text(const std::map<std::string, int>& stops) {
  std::string text;
  for (const auto& [reason, count] : stops)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason);
  return text;
}

WordTable detector_table(const GapBenchmark& b) {
  WordTable t{
      "Detectors",
      "Reading of one rendered picture less the true gap, at gaps of 0.08 to 0.25 mm. A frame is missed "
      "when no dot is found or it is not believed.",
      {"surface", "condition", "detector", "frames", "missed", "bias um", "sigma um", "95 % um"},
      3,
      {}};
  for (const DetectorRow& r : b.detectors) {
    const bool seen = r.frames > r.missed;
    t.rows.push_back({r.surface, r.condition, r.detector, std::to_string(r.frames), std::to_string(r.missed),
                      seen ? digits(r.bias_um, 1) : "", seen ? digits(r.sigma_um, 1) : "",
                      seen ? digits(r.p95_um, 1) : ""});
  }
  return t;
}

WordTable approach_table(const GapBenchmark& b) {
  WordTable t{
      "Approach",
      "From 2 mm above to the aim, by machines whose tip is off. A stop in good light is a false one.",
      {"surface", "condition", "runs", "reached", "touches", "false stops", "error um", "95 %", "settles s",
       "95 %", "stops"},
      2,
      {}};
  for (const ApproachRow& r : b.approaches)
    t.rows.push_back(
        {r.surface, r.condition, std::to_string(r.runs), std::to_string(r.reached), std::to_string(r.touches),
         std::to_string(r.false_stops), r.reached ? digits(r.error_um.median, 1) : "",
         r.reached ? digits(r.error_um.p95, 1) : "", r.reached ? digits(r.settle_s.median, 2) : "",
         r.reached ? digits(r.settle_s.p95, 2) : "", stops_text(r.stops)});
  return t;
}

WordTable following_table(const GapBenchmark& b) {
  WordTable t{"Following",
              "Approach and bead on machines whose error changes along the path; gap over the bead.",
              {"surface", "condition", "runs", "completed", "touches", "false stops", "in band %", "error um",
               "95 %", "frames followed %", "stops"},
              2,
              {}};
  for (const FollowingRow& r : b.followings) {
    const bool any = r.in_band_fraction > 0;
    t.rows.push_back({r.surface, r.condition, std::to_string(r.runs), std::to_string(r.completed),
                      std::to_string(r.touches), std::to_string(r.false_stops),
                      any ? digits(100 * r.in_band_fraction, 1) : "", any ? digits(r.error_um.median, 1) : "",
                      any ? digits(r.error_um.p95, 1) : "", any ? digits(100 * r.followed_fraction, 1) : "",
                      stops_text(r.stops)});
  }
  return t;
}

WordTable bottle_table(const GapBenchmark& b) {
  WordTable t{
      "Bottle",
      "The line of Song 2015, 6.2 on as-built machines with the errors left after calibration; gap along "
      "the path of all machines together. Kept: at least 99 % of the path in the band.",
      {"gap control", "machines", "printed", "touched", "kept", "in band %", "worst %", "gap 1 % mm",
       "median mm", "99 % mm", "stops"},
      1,
      {}};
  for (const BottleRow& r : b.bottle)
    t.rows.push_back({r.mode, std::to_string(r.machines), std::to_string(r.printed),
                      std::to_string(r.touched), std::to_string(r.kept), digits(100 * r.in_band_fraction, 1),
                      digits(100 * r.in_band_worst, 1), digits(r.gap_p01_mm, 3), digits(r.gap_median_mm, 3),
                      digits(r.gap_p99_mm, 3), stops_text(r.stops)});
  return t;
}

std::vector<WordTable> tables_of(const GapBenchmark& b) {
  std::vector<WordTable> all;
  for (const studies::FaultedTwin& faulted : b.faulted)
    for (WordTable& table : faulted_twin_tables(faulted)) all.push_back(std::move(table));
  for (WordTable table : {bottle_table(b), following_table(b), approach_table(b), detector_table(b)})
    if (!table.rows.empty()) all.push_back(std::move(table));
  return all;
}

}  // namespace

std::string gap_benchmark_json(const GapBenchmark& b) {
  Json json;
  json["schema"] = "understudy.gap-benchmark/1";
  json["machine"] = b.request.machine;
  json["gap"] = {
      {"aim_mm", number(b.aim_mm)}, {"min_mm", number(b.band_min_mm)}, {"max_mm", number(b.band_max_mm)}};
  json["trials"] = b.request.trials;
  json["seed"] = std::to_string(b.request.seed);
  if (!b.detectors.empty()) json["detectors"] = detectors_value(b);
  if (!b.approaches.empty()) json["approaches"] = approaches_value(b);
  if (!b.followings.empty()) json["followings"] = followings_value(b);
  if (!b.bottle.empty()) json["bottle"] = bottle_value(b);
  for (const studies::FaultedTwin& faulted : b.faulted)
    json[faulted.task == studies::FaultedTask::approach ? "faulted_approaches" : "faulted_prints"] =
        faulted_twin_value(faulted);
  json["provenance"] = {
      {"version", kVersion}, {"machine_sha256", b.machine_sha256}, {"command", b.request.command}};
  return to_text(json, 2) + "\n";
}

std::string gap_benchmark_table(const GapBenchmark& b) {
  std::string text;
  for (const WordTable& table : tables_of(b)) text += (text.empty() ? "" : "\n") + plain_text(table);
  return text;
}

std::string gap_benchmark_html(const GapBenchmark& b) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>Gap benchmark</title>\n<style>\n";
  html += kPageStyle;
  html += fmt::format(
      "</style></head><body><main><p class=\"eyebrow\">Understudy {}</p><h1>Gap benchmark: {}</h1>\n"
      "<p class=\"note\">Aim {:.3f} mm, accepted {:.2f} to {:.2f} mm, seed {}. <code>{}</code></p>\n",
      html_text(kVersion), html_text(b.request.machine), b.aim_mm, b.band_min_mm, b.band_max_mm,
      b.request.seed, html_text(b.request.command));
  html += gap_benchmark_charts(b);
  for (const WordTable& table : tables_of(b)) html += html_section(table);
  return html + "</main></body></html>\n";
}

}  // namespace understudy::report
