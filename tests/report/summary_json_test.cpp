#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/summary_json.h"
#include "tests/report/sample_record.h"

namespace understudy::report {
namespace {

using rehearsal::AccuracyFigures;
using rehearsal::CalibrationFigures;
using rehearsal::Record;
using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

using Keys = std::vector<std::string>;

TEST(SummaryJson, HasTheContractsKeysInItsOrder) {
  const Json summary = Json::parse(summary_json(sample_go()));
  EXPECT_EQ(keys(summary), (Keys{"schema", "verdict", "go", "grade", "findings", "finding_groups", "print",
                                 "accuracy", "gap", "collision", "engine", "provenance"}));
  EXPECT_EQ(summary["schema"], "understudy.rehearsal/1");
  EXPECT_EQ(summary["verdict"], "go");
  EXPECT_EQ(summary["go"], true);
  EXPECT_EQ(summary["grade"], "go-with-warnings");
  EXPECT_EQ(keys(summary["findings"][0]),
            (Keys{"kind", "severity", "gcode_line", "time_s", "value", "limit", "unit", "message"}));
  EXPECT_EQ(keys(summary["print"]),
            (Keys{"duration_s", "moves", "extruded_mm", "printed_mm", "purged_mm", "missing_mm", "primed_mm",
                  "deposited_mm", "spanning_mm", "travel_mm", "tilt_max_deg", "turned_deg", "fill_factor"}));
  EXPECT_EQ(keys(summary["accuracy"]),
            (Keys{"tip_rms_um", "tip_p95_um", "tip_max_um", "orientation_max_mrad", "open_loop_tip_max_um",
                  "tip_tolerance_mm", "orientation_tolerance_deg"}));
  EXPECT_EQ(keys(summary["gap"]), (Keys{"commanded_mm", "open_loop_start_mm", "start_mm", "path_min_mm",
                                        "path_mean_mm", "path_max_mm", "in_band_fraction", "frames"}));
  EXPECT_EQ(keys(summary["collision"]),
            (Keys{"min_clearance_mm", "closest", "nozzle_clearance_mm", "checks", "pairs"}));
  EXPECT_EQ(keys(summary["engine"]), (Keys{"name", "version", "timestep_s", "steps", "closure_max_um"}));
  EXPECT_EQ(keys(summary["provenance"]),
            (Keys{"version", "machine_sha256", "program_sha256", "seed", "as_built", "command"}));
}

TEST(SummaryJson, LeavesOutWhatIsAbsent) {
  const Json stopped = Json::parse(summary_json(sample_stopped_by_constraints()));
  EXPECT_EQ(keys(stopped),
            (Keys{"schema", "verdict", "go", "grade", "findings", "finding_groups", "provenance"}));
  EXPECT_EQ(stopped["verdict"], "no-go");
  EXPECT_FALSE(Json::parse(summary_json(sample_without_gap_control()))["gap"].contains("open_loop_start_mm"));
  Record record = sample_go();
  record.findings[0].gcode_line = 0;  // lines count from 1
  EXPECT_FALSE(Json::parse(summary_json(record))["findings"][0].contains("gcode_line"));
}

TEST(SummaryJson, TellsBothSidesOfACalibration) {
  Record record = sample_go();
  record.calibration = CalibrationFigures{"hexapod", "m.yaml", "", AccuracyFigures{4000, 5000, 6000, 7, 0},
                                          AccuracyFigures{40, 50, 60, 0.7, 0}};
  const Json c = Json::parse(summary_json(record))["calibration"];
  EXPECT_EQ(keys(c), (Keys{"machine_before", "machine_after", "tip_rms_before_um", "tip_rms_after_um",
                           "tip_p95_before_um", "tip_p95_after_um", "tip_max_before_um", "tip_max_after_um",
                           "orientation_max_before_mrad", "orientation_max_after_mrad"}));
  EXPECT_EQ(c["tip_p95_before_um"], 5000);
  EXPECT_EQ(c["tip_max_after_um"], 60);
  record.calibration->before.reset();
  record.calibration->not_run_before = "strut 3 is 241.7 mm, longer than 240.0 mm";
  EXPECT_EQ(keys(Json::parse(summary_json(record))["calibration"]),
            (Keys{"machine_before", "machine_after", "not_run_before", "tip_rms_after_um", "tip_p95_after_um",
                  "tip_max_after_um", "orientation_max_after_mrad"}));
}

TEST(SummaryJson, NumbersCarrySixDigitsAndDoNotHangOnTheLastBit) {
  Record record = sample_go();
  record.accuracy->tip_rms_um = 88.123456;
  EXPECT_NE(summary_json(record).find("\"tip_rms_um\": 88.1235,"), std::string::npos);
  const std::string text = summary_json(record);
  record.accuracy->tip_rms_um = std::nextafter(88.123456, 100.0);
  EXPECT_EQ(summary_json(record), text);
  record.accuracy->tip_rms_um = -1e-300 * 1e-300;
  EXPECT_NE(summary_json(record).find("\"tip_rms_um\": 0.0,"), std::string::npos);
}

TEST(SummaryJson, CountsKeepEveryDigit) {
  Record record = sample_go();
  record.engine->steps = 18446744073709551615u;
  const Json summary = Json::parse(summary_json(record));
  EXPECT_EQ(summary["engine"]["steps"].get<std::uint64_t>(), 18446744073709551615u);
  EXPECT_EQ(summary["provenance"]["seed"].get<std::uint64_t>(), 12345678901234567890u);
}

TEST(SummaryJson, NamesTheLibrariesByVersion) {
  Record record = sample_go();
  record.provenance.libraries = {{"MuJoCo", "2.2.2"}, {"FCL", "0.7.0"}};
  EXPECT_EQ(Json::parse(summary_json(record))["provenance"]["libraries"].dump(),
            R"({"FCL":"0.7.0","MuJoCo":"2.2.2"})");
}

TEST(SummaryJson, ANumberThatIsNotFiniteIsOurOwnMistake) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  const std::function<void(Record&, double)> places[] = {
      [](Record& r, double v) { r.findings[0].value = v; },
      [](Record& r, double v) { r.print->duration_s = v; },
      [](Record& r, double v) { r.accuracy->tip_max_um = v; },
      [](Record& r, double v) { r.gap->start_mm = v; },
      [](Record& r, double v) { r.gap->open_loop_start_mm = v; },
      [](Record& r, double v) { r.collision->min_clearance_mm = v; }};
  for (const double value : bad)
    for (const auto& put : places) {
      Record record = sample_go();
      put(record, value);
      EXPECT_THROW(summary_json(record), std::logic_error);
    }
}

TEST(SummaryJson, MessagesThatAreNotUtf8AreRepairedNotRefused) {
  Record record = sample_go();
  record.findings[0].message = "line with \xE9 from another century";
  EXPECT_EQ(Json::parse(summary_json(record))["findings"][0]["message"],
            "line with \xEF\xBF\xBD from another century");
}

}  // namespace
}  // namespace understudy::report
