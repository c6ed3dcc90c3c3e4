#include "report/recorded/recorded_rehearsal.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "report/page/write_results.h"
#include "tests/report/sample_record.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ReadRehearsal : public testing::Test {
 protected:
  void write(rehearsal::Record record) const {
    record.provenance.inputs_sha256 = std::string(64, 'a');
    OutputFolder out(result());
    write_results(record, {}, out.path());
    out.commit();
  }
  /// Also in the manifest, as a run would have written it.
  void change(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = read_file(result() / file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(result() / file, text.replace(at, from.size(), to));
    fs::remove(result() / kManifest);
  }
  fs::path result() const { return folder_ / "result"; }
  std::string refusal() const {
    try {
      (void)read_recorded_rehearsal(result());
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
};

TEST_F(ReadRehearsal, GivesBackWhatTheRecordSays) {
  const rehearsal::Record record = sample_no_go();
  write(record);
  const RecordedRehearsal read = read_recorded_rehearsal(result());
  EXPECT_EQ(read.grade, rehearsal::Grade::no_go);
  EXPECT_FALSE(read.run.go);
  EXPECT_EQ(std::get<double>(read.figures.at("gap.frames")), static_cast<double>(record.gap->frames));
  EXPECT_FALSE(read.figures.contains("verdict"));
  EXPECT_FALSE(read.figures.contains("findings.0.kind"));
  int findings = 0;
  for (const auto& group : read.findings) findings += group.count;
  EXPECT_EQ(findings, 30);
  EXPECT_EQ(read.inputs.at("program file"), record.provenance.program_sha256);
  ASSERT_EQ(read.trace.size(), record.trace.size());
  EXPECT_NEAR(read.trace[100].tip_error, record.trace[100].tip_error,
              1e-9);  // decimals of the file: 0.001 um
  EXPECT_NEAR(read.trace[100].time, record.trace[100].time, 1e-6);
}

TEST_F(ReadRehearsal, ARunThatWasStoppedBeforehandHasNoTrace) {
  write(sample_stopped_by_constraints());
  const RecordedRehearsal read = read_recorded_rehearsal(result());
  EXPECT_TRUE(read.trace.empty());
  EXPECT_FALSE(read.findings.empty());
}

TEST_F(ReadRehearsal, SeedsKeepEveryDigit) {
  rehearsal::Record record = sample_go();
  record.provenance.seed = 18446744073709551615U;
  write(record);
  EXPECT_EQ(read_recorded_rehearsal(result()).inputs.at("seed"), "18446744073709551615");
}

TEST_F(ReadRehearsal, WhatIsNotWholeIsRefused) {
  EXPECT_THAT(refusal(), HasSubstr("is no folder"));
  write(sample_go());
  change("summary.json", "understudy.rehearsal/1", "understudy.rehearsal/2");
  EXPECT_THAT(refusal(),
              HasSubstr("it is 'understudy.rehearsal/2', where this program reads understudy.rehearsal/1"));
  change("summary.json", "understudy.rehearsal/2", "understudy.rehearsal/1");
  change("summary.json", "\"start_mm\": ", "\"start_mm\": NaN, \"was\": ");
  EXPECT_THAT(refusal(), HasSubstr("no summary of a rehearsal"));
  change("summary.json", "NaN", "1e999");
  EXPECT_THAT(refusal(), HasSubstr("no summary of a rehearsal"));
  change("summary.json", "1e999", "0.1");
  change("summary.json", "finding_groups", "finding_grapes");
  EXPECT_THAT(refusal(), HasSubstr("summary.json: it is damaged, or an older version wrote it"));
  change("summary.json", "finding_grapes", "finding_groups");
  EXPECT_EQ(refusal(), "accepted");
  fs::remove(result() / "trace.csv");
  EXPECT_THAT(refusal(), HasSubstr("trace.csv: it is missing"));
}

TEST_F(ReadRehearsal, CountsThatAreNoneAreRefused) {
  write(sample_no_go());
  change("summary.json", "\"count\": ", "\"count\": -4, \"was\": ");
  EXPECT_THAT(refusal(), HasSubstr("count is -4"));
  change("summary.json", "\"count\": -4", "\"count\": 1e300");
  EXPECT_THAT(refusal(), HasSubstr("count is 1e+300"));
}

TEST_F(ReadRehearsal, AFileThatTheManifestDoesNotKnowSoIsRefused) {
  write(sample_go());
  std::string trace = read_file(result() / "trace.csv");
  trace.resize(trace.rfind('\n', trace.size() - 2) + 1);  // at the end of a line: nothing else shows it
  write_file(result() / "trace.csv", trace);
  EXPECT_THAT(refusal(), HasSubstr("trace.csv: it is not the file that manifest.sha256 names"));
}

}  // namespace
}  // namespace understudy::report
