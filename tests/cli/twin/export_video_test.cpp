// The film of a rehearsal, read back as a player reads it.
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "core/file/read_file.h"
#include "tests/cli/twin/exported_print.h"
#include "vision/formats/formats.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::vector<cv::Mat> pictures_of(const std::string& file) {
  const auto video = vision::formats().open_file(file);
  std::vector<cv::Mat> frames;
  if (!video) return frames;
  for (cv::Mat frame; video->read(frame);) frames.push_back(frame.clone());
  return frames;
}

/// Pixels of the right half, where the print is seen from close by, that are as orange as filament.
int orange_pixels(const cv::Mat& frame) {
  int count = 0;
  for (int row = 0; row < frame.rows * 3 / 4; ++row)
    for (int column = frame.cols / 2; column < frame.cols; ++column) {
      const auto& p = frame.at<cv::Vec3b>(row, column);  // blue, green, red
      count += p[2] > 120 && p[2] > p[1] + 25 && p[1] > p[0] + 10;
    }
  return count;
}

class ExportVideo : public ExportedPrint {
 protected:
  ExportVideo() : ExportedPrint("video", "mp4") {}
};

class ExtendedExportVideo : public ExportVideo {};

TEST_F(ExtendedExportVideo, TheBeadsGrowFromTheFirstFrameToTheLast) {
  ASSERT_LE(rehearse(kLine).status, 1);
  const Outcome outcome = run_export(out() + " --seconds 1 --fps 6 --size 640x360 -o " + exported());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(without_progress(outcome.err), "");
  EXPECT_THAT(outcome.out, HasSubstr("6 frames of 640 x 360 pixels"));
  const auto frames = pictures_of(exported());
  ASSERT_EQ(frames.size(), 6U);
  for (const cv::Mat& frame : frames) EXPECT_EQ(frame.size(), cv::Size(640, 360));
  // The path to come is a line two pixels wide, beads are several times as wide.
  const int first = orange_pixels(frames.front()), late = orange_pixels(frames[4]),
            last = orange_pixels(frames.back());
  EXPECT_GT(first, 100);
  EXPECT_GT(2 * late, 3 * first);
  EXPECT_GT(last, late);
  EXPECT_GT(last, 2 * first);
}

TEST_F(ExportVideo, ARehearsalRefusesAFilmThatItCannotMakeBeforeItRuns) {
  const Outcome refused = rehearse(kLine, "--video " + (folder_ / "out/in.mp4"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("name a place outside"));
  EXPECT_FALSE(fs::exists(out())) << "refused before the run";
  EXPECT_EQ(rehearse(kLine, "--no-pictures --video " + exported()).status, 2);
}

TEST_F(ExportVideo, WhatCannotBeMadeIsRefusedInOneLine) {
  ASSERT_LE(rehearse(kLine).status, 1);
  refused(out() + " -o " + (folder_ / "line.avi"), "does not end in .mp4");
  refused(out() + " --size 640 -o " + exported(), "1280x720");
  refused(out() + " --size 642x360 -o " + exported(), "by fours");
  refused(out() + " --seconds 0 -o " + exported(), "0.2..600");
  refused(out() + " --fps 100 -o " + exported(), "1..60");
  refused((folder_ / "nothing") + " -o " + exported(), "nothing");
  ASSERT_LE(rehearse(kLine, "--no-pictures").status, 1);
  refused(out() + " -o " + exported(), "replay");
}

void expect_cannot_write(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 3) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, MatchesRegex("understudy: [^\n]*\n"));
  EXPECT_THAT(outcome.err, HasSubstr("cannot write"));
}

TEST_F(ExtendedExportVideo, AFullDiskIsOneLineAndLeavesNothing) {
  if (!can_make_disks()) GTEST_SKIP() << "needs the right to mount a file system";
  ASSERT_LE(rehearse(kLine).status, 1);
  const std::string words = "export video " + out() + " --quiet --seconds 1 --fps 6 --size 640x360 -o ";
  const std::string disk = folder_ / "disk";
  fs::create_directory(disk);

  // Where the film is encoded: before a frame is drawn.
  const Outcome encoded =
      understudy_after("TMPDIR=" + disk + " " + with_small_disk(disk, 16), words + exported());
  expect_cannot_write(encoded);
  EXPECT_EQ(encoded.out, "") << "nothing stays on the disk";
  EXPECT_FALSE(fs::exists(exported()));
  // Where it shall lie: nothing under its name, and nothing beside it.
  const Outcome placed = understudy_after(with_small_disk(disk, 16), words + disk + "/line.mp4");
  expect_cannot_write(placed);
  EXPECT_EQ(placed.out, "");
}

TEST_F(ExtendedExportVideo, AFullDiskCostsARehearsalItsFilmAlone) {
  if (!can_make_disks()) GTEST_SKIP() << "needs the right to mount a file system";
  const std::string disk = folder_ / "disk";
  fs::create_directory(disk);
  const Outcome outcome = understudy_after("TMPDIR=" + disk + " " + with_small_disk(disk, 16),
                                           "rehearse \"" + folder_.write("line.gcode", kLine) +
                                               "\" --quiet --engine quasistatic --gap-control off --out " +
                                               out() + " --video " + exported());
  expect_cannot_write(outcome);
  EXPECT_FALSE(fs::exists(exported()));
  EXPECT_TRUE(fs::exists(out() + "/report.html") && fs::exists(out() + "/manifest.sha256"));
}

TEST_F(ExtendedExportVideo, AnInterruptLeavesNoHalfFile) {
  ASSERT_LE(rehearse(kLine).status, 1);
  const Outcome outcome = understudy_interrupted("export video " + out() + " -o " + exported(), 4);
  EXPECT_EQ(outcome.status, 128 + 2) << outcome.out << outcome.err;
  EXPECT_FALSE(fs::exists(exported()));
}

}  // namespace
}  // namespace understudy::cli_test
