#include "report/recorded/verification.h"
#include "report/recorded/recorded_run.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "report/summary_json.h"
#include "tests/report/sample_record.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Verification : public testing::Test {
 protected:
  Verification() {
    for (const char* name : {"a", "b"}) {
      fs::create_directories(root / name / "frames");
      write(name, "summary.json", R"({"go": true, "gap": {"start_mm": 0.13}})");
      write(name, "trace.csv", "time_s\n0\n1\n");
      write(name, "frames/1.png", "pixels");
    }
  }
  void write(const std::string& folder, const std::string& name, const std::string& text) const {
    write_file(root / folder / name, text);
  }
  std::string only_difference() const {
    const auto found = compare_results(root / "a", root / "b");
    return found.size() == 1 ? found[0].file + ": " + found[0].details : std::to_string(found.size());
  }
  TemporaryFolder root;
};

TEST_F(Verification, EqualFoldersDoNotDifferWhateverTheirTimesAre) {
  write("a", "timing.json", "{\"wall_s\": 1}");
  write("b", "timing.json", "{\"wall_s\": 2}");
  write("a", "manifest.sha256", "abc");
  EXPECT_EQ(only_difference(), "0");
  EXPECT_THAT(compared_files(root / "a"), ElementsAre("frames/1.png", "summary.json", "trace.csv"));
}

TEST_F(Verification, TellsWhichValuesAndWhichLineDiffer) {
  write("b", "summary.json", R"({"go": false, "gap": {"start_mm": 0.14}})");
  EXPECT_THAT(only_difference(), HasSubstr("/gap/start_mm is 0.14, was 0.13"));
  EXPECT_THAT(only_difference(), HasSubstr("/go is false, was true"));
  write("b", "summary.json", R"({"go": true, "gap": {"start_mm": 0.13}})");
  write("b", "trace.csv", "time_s\n0\n2\n");
  EXPECT_EQ(only_difference(), "trace.csv: from byte 10, line 3, on");
}

TEST_F(Verification, SaysNoMoreOfJsonThatIsNestedTooDeep) {
  const auto nested = [](char in) { return std::string(200'000, '[') + in + std::string(200'000, ']'); };
  write("a", "summary.json", nested('1'));
  write("b", "summary.json", nested('2'));
  EXPECT_EQ(only_difference(), "summary.json: one of them is nested more than 100 deep");
}

TEST_F(Verification, TellsOfFilesThatOneOfThemLacks) {
  fs::remove(root / "b" / "frames" / "1.png");
  EXPECT_EQ(only_difference(), "frames/1.png: it is no longer written");
  fs::remove(root / "a" / "frames" / "1.png");
  write("b", "profile.csv", "");
  EXPECT_EQ(only_difference(), "profile.csv: it was not written then");
}

TEST_F(Verification, ARecordedRunIsThatOfTheRecord) {
  rehearsal::Record record = sample_go();
  record.provenance.inputs_sha256 = std::string(64, 'a');
  write("a", "summary.json", summary_json(record));
  const RecordedRun run = read_recorded_run(root / "a");
  EXPECT_EQ(run.command, record.provenance.command);
  EXPECT_EQ(run.inputs_sha256, record.provenance.inputs_sha256);
  EXPECT_EQ(run.program_sha256, record.provenance.program_sha256);
}

TEST_F(Verification, WhatIsNoSummaryOfARehearsalIsRefused) {
  const auto refusal = [&](const std::string& text) -> std::string {
    write("a", "summary.json", text);
    try {
      (void)read_recorded_run(root / "a");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const char* text : {"", "[]", "7", "{\"schema\": 3}", "{\"schema\": \"understudy.calibration/1\"}"})
    EXPECT_THAT(refusal(text), HasSubstr("no summary of a rehearsal")) << text;
  EXPECT_THAT(refusal(R"({"schema": "understudy.rehearsal/1", "provenance": {"command": 3}})"),
              HasSubstr("provenance.command is missing"));
  EXPECT_THAT(refusal(std::string(100'000, '[')), HasSubstr("nested more than 100 deep"));
  EXPECT_THROW(read_recorded_run(root / "none"), InputError);
}

}  // namespace
}  // namespace understudy::report
