// What a calibration says in words, JSON and on its page is the same.
#include "report/calibration/calibration_summary.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "calibration/machine/calibrate_machine.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "report/page/calibration_page.h"
#include "tests/calibration/machine/measured_machine.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

calibration::MachineCalibration calibrated(bool frame = false, const std::string& plugin = "") {
  const auto machine = machine::load_machine("hexapod");
  auto table = calibration::BuiltMachine(machine, 5).measured(machine, 24);
  if (frame) table.frame = {30e-6, 0, 0};
  const TemporaryFolder folder;
  const auto path = folder / "poses.csv";
  write_file(path, calibration::measurements_csv(table, machine, "test"));
  calibration::CalibrationRequest request;
  request.measurements = path.string();
  request.plugin = plugin;
  return calibration::calibrate_machine(request);
}

TEST(CalibrationSummary, SummaryAndPageHaveWhatTheTextSays) {
  const auto result = calibrated();
  const auto summary = nlohmann::json::parse(calibration_json(result));
  EXPECT_EQ(summary["schema"], "understudy.calibration/1");
  EXPECT_EQ(summary["parameters"].size(), 42u);
  EXPECT_EQ(summary["samples"].size(), 24u);
  EXPECT_NEAR(summary["tip"]["sigma_median_um"].get<double>(), to_um(result.tip.median), 1e-3);
  EXPECT_LT(summary["residual"]["tip_rms_after_um"], summary["residual"]["tip_rms_before_um"]);
  const std::string page = calibration_html(result);
  EXPECT_THAT(page, AllOf(HasSubstr("base joint 6 z"), HasSubstr("Parameters are correlated")));
  for (const char* outside : {"http://", "https://", ">nan", ">inf"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(calibration_html(calibrated()), page);
}

TEST(CalibrationSummary, TellsTheMeasuringFrame) {
  const auto result = calibrated(true);
  EXPECT_THAT(calibration_text(result), HasSubstr("of which the measuring frame"));
  EXPECT_EQ(nlohmann::json::parse(calibration_json(result)).at("frame").at("position_um"), 30);
}

// Without a covariance there is no number to print in its place.
TEST(CalibrationSummary, OfAPlugInInventsNoUncertainty) {
  const auto result =
      calibrated(false, "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/strut_by_strut.py");
  EXPECT_THAT(calibration_text(result), AllOf(HasSubstr("not known"), ::testing::Not(HasSubstr("nan"))));
  const auto summary = nlohmann::json::parse(calibration_json(result));
  EXPECT_TRUE(summary["tip"]["sigma_rms_um"].is_null());
  EXPECT_TRUE(summary["parameters"][0]["sigma"].is_null());
  // The number, not the letters within a word.
  EXPECT_THAT(calibration_html(result), ::testing::Not(::testing::ContainsRegex("[^a-z]nan[^a-z]")));
}

}  // namespace
}  // namespace understudy::report
