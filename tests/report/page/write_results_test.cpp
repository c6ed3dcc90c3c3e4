#include "report/page/write_results.h"

#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "report/summary_json.h"
#include "tests/report/sample_record.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

class WriteResults : public testing::Test {
 protected:
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.is_regular_file())
        found[entry.path().lexically_relative(folder_.path()).string()] = read_file(entry.path());
    return found;
  }

  const TemporaryFolder folder_;
};

TEST_F(WriteResults, WritesEveryFileOfARun) {
  write_results(sample_go(), sample_pictures, folder_.path());
  const auto written = files();
  for (const char* name : {"summary.json", "timing.json", "report.html", "trace.csv", "frames/approach.csv",
                           "frames/approach-01.png", "frames/approach-10.png", "pictures/picture-01.png",
                           "pictures/picture-02.png"})
    EXPECT_TRUE(written.contains(name)) << name;
  EXPECT_EQ(written.size(), 4u + 11u + 2u);
  EXPECT_EQ(written.at("summary.json"), summary_json(sample_go()));
}

TEST_F(WriteResults, WritesOnlyWhatThereIs) {
  write_results(sample_stopped_by_constraints(), {}, folder_.path());
  const auto written = files();
  EXPECT_EQ(written.size(), 2u);
  EXPECT_TRUE(written.contains("summary.json") && written.contains("report.html"));
}

TEST_F(WriteResults, EqualRecordsGiveEqualBytes) {
  write_results(sample_no_go(), sample_pictures, folder_.path());
  const auto first = files();
  write_results(sample_no_go(), sample_pictures, folder_.path());
  EXPECT_EQ(files(), first);
}

TEST_F(WriteResults, FrameTableHasEmptyCellsWhereNothingWasMeasured) {
  rehearsal::Record record = sample_go();
  record.frames.resize(1);
  record.frames[0].look.dot.status = vision::DotStatus::no_dot;
  record.frames[0].look.reading = {};
  record.frames[0].true_dot_px.reset();
  record.frames[0].look.used = false;
  write_results(record, {}, folder_.path());
  const std::string table = read_file(folder_ / "frames" / "approach.csv");
  EXPECT_THAT(table, testing::HasSubstr("\napproach-01.png,0.600000,410,400,no dot,,,,,,,2.000000,0\n"));
}

// The command made it before the work: it has vanished meanwhile.
TEST_F(WriteResults, AFolderThatIsNotThereIsNoMistakeOfTheUsers) {
  EXPECT_THROW(write_results(sample_go(), sample_pictures, folder_ / "missing"), MachineError);
}

}  // namespace
}  // namespace understudy::report
