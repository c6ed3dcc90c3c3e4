#include "report/video/mp4_writer.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace understudy::report {
namespace {
namespace fs = std::filesystem;

/// Temporary files are made in a folder of the test's.
class Mp4WriterTest : public testing::Test {
 protected:
  Mp4WriterTest() {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder_.path().c_str(), 1);
  }
  ~Mp4WriterTest() override {
    if (before_.empty()) {
      ::unsetenv("TMPDIR");
    } else {
      ::setenv("TMPDIR", before_.c_str(), 1);
    }
  }

  static void add_frames(Mp4Writer& writer) {
    for (int shade = 0; shade < 12; ++shade)
      writer.add(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(20 * shade)));
  }
  fs::path file() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.path().filename() == "frames.mp4") return entry.path();
    return {};
  }

  TemporaryFolder folder_;
  std::string before_;
};

TEST_F(Mp4WriterTest, AFilmIsABoxOfTheFormatAndItsFolderGoes) {
  {
    Mp4Writer writer(10, {320, 240});
    add_frames(writer);
    EXPECT_EQ(writer.finish().substr(4, 4), "ftyp");  // ISO/IEC 14496-12, 4.3
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Mp4WriterTest, AFilmThatIsLostAfterItsFramesWereDrawnIsAnError) {
  Mp4Writer writer(10, {320, 240});
  add_frames(writer);
  ASSERT_FALSE(file().empty());
  fs::remove(file());
  try {
    writer.finish();
    FAIL() << "no error";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("0 of 12 frames of the film are there; is the disk full?"));
  }
}

}  // namespace
}  // namespace understudy::report
