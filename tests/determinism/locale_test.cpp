// The rooms are libraries as well, and a program that links them may have chosen a locale with a decimal
// comma and grouped thousands. What is read and written stays as it is.
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calibration/machine/calibrate_machine.h"
#include "machine/description.h"
#include "machine/file/calibration_section.h"
#include "rehearsal/rehearse.h"
#include "report/calibration/calibration_summary.h"
#include "report/page/report_data.h"
#include "report/page/report_html.h"
#include "report/summary_json.h"
#include "report/trace/trace_csv.h"
#include "tests/temporary_folder.h"
#include "toolpath/gcode/gcode.h"
#include "vision/boards/rig_file.h"

namespace understudy {
namespace {

const std::string kSource = UNDERSTUDY_SOURCE_DIR;

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// How fast the run was differs between any two.
std::string without_times(std::string text) {
  const std::string key = "\"real_time_factor\":";
  for (std::size_t at = 0; (at = text.find(key, at)) != std::string::npos; ++at)
    text.erase(at, text.find_first_of(",}\n", at) - at);
  return text;
}

void add_rehearsal(std::vector<std::string>& texts) {
  rehearsal::RehearsalRequest request;
  request.program = kSource + "/scenarios/song-bottle.gcode";
  request.fixture = "bottle";
  request.engine = "quasistatic";
  request.gap_control = "off";
  request.keep_scene = false;
  const rehearsal::Record record = rehearsal::rehearse(request);
  texts.push_back(without_times(report::summary_json(record)));
  texts.push_back(report::trace_csv(record));
  texts.push_back(without_times(report::report_html(record, report::report_data(record))));
  texts.push_back(record.as_built);
}

/// A joint that goes beyond its limit: the message of the finding has figures.
void add_violation(std::vector<std::string>& texts) {
  const kinematics::LimitViolation strut{kinematics::LimitKind::strut_length, "strut 3", 0.2417, 0.24, "m"};
  EXPECT_EQ(kinematics::to_string(strut), "strut 3 is 241.7 mm, longer than 240.0 mm");
  texts.push_back(kinematics::to_string(strut));
}

void add_calibration(std::vector<std::string>& texts) {
  calibration::CalibrationRequest request;
  request.measurements = kSource + "/scenarios/calibration/hexapod-24-poses.csv";
  const calibration::MachineCalibration result = calibration::calibrate_machine(request);
  texts.push_back(report::calibration_json(result));
  texts.push_back(report::calibration_text(result));
  texts.push_back(machine::calibration_section(result.machine, result.stored));
}

std::vector<std::string> results() {
  std::vector<std::string> texts;
  add_rehearsal(texts);
  add_violation(texts);
  add_calibration(texts);
  texts.push_back(
      toolpath::write_gcode(toolpath::read_gcode(kSource + "/scenarios/song-bottle.gcode", {}), {}));
  texts.push_back(vision::rig_yaml(vision::load_rig(kSource + "/examples/rig.yaml"), "rig"));
  return texts;
}

void expect_same(const std::vector<std::string>& ours, const std::vector<std::string>& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    EXPECT_TRUE(ours[i] == theirs[i]) << i << '\n' << theirs[i].substr(0, 2000);
}

TEST(Locale, OfStreamsDoesNotChangeTheResults) {
  const std::vector<std::string> plain = results();
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::vector<std::string> foreign = results();
  std::locale::global(before);
  expect_same(plain, foreign);
}

TEST(Locale, OfTheCLibraryDoesNotChangeTheResults) {
  const TemporaryFolder folder;
  const std::string make =
      "localedef -i de_DE -f ISO-8859-1 --no-archive '" + (folder / "de_DE").string() + "' 2>/dev/null";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "localedef cannot make de_DE: package locales";
  const std::vector<std::string> plain = results();
  ::setenv("LOCPATH", folder.path().c_str(), 1);
  ASSERT_NE(std::setlocale(LC_ALL, "de_DE"), nullptr);
  char text[20];
  std::snprintf(text, sizeof text, "%.1f", 1.5);
  const std::vector<std::string> foreign = results();
  std::setlocale(LC_ALL, "C");
  EXPECT_STREQ(text, "1,5");
  expect_same(plain, foreign);
}

}  // namespace
}  // namespace understudy
