#include "vision/formats/formats.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/temporary_folder.h"

namespace understudy::vision {
namespace {

// Written by hand from the description of BMP: 2 x 1 pixels of 24 bits, blue first, rows filled up to four
// bytes.
std::string bitmap() {
  const auto words = [](std::initializer_list<unsigned> values) {
    std::string bytes;
    for (const unsigned value : values)
      for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xffu);
    return bytes;
  };
  const unsigned planes_and_bits = 1u | 24u << 16;
  return "BM" + words({62, 0, 54, 40, 2, 1, planes_and_bits, 0, 8, 2835, 2835, 0, 0}) +
         std::string("\xff\x00\x00\x40\x40\x40\x00\x00", 8);
}

// Luminance of ITU-R BT.601: 0.114 of 255 is 29.1.
TEST(Formats, ABitmapIsReadByItsLuminance) {
  const cv::Mat grey = formats().decode_grey(bitmap());
  ASSERT_EQ(grey.type(), CV_8UC1);
  ASSERT_EQ(grey.size(), cv::Size(2, 1));
  EXPECT_NEAR(grey.at<unsigned char>(0, 0), 29.1, 0.8);
  EXPECT_EQ(grey.at<unsigned char>(0, 1), 0x40);
}

TEST(Formats, WhatIsNoPictureAndNoVideoGivesNothing) {
  EXPECT_TRUE(formats().decode_grey("").empty());
  EXPECT_TRUE(formats().decode_grey("x_mm,y_mm\n1,2\n").empty());
  testing::internal::CaptureStderr();
  EXPECT_TRUE(formats().decode_grey(bitmap().substr(0, 40)).empty());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "what is wrong is said once, by who asked";
  EXPECT_EQ(formats().open_file("absent.mp4"), nullptr);
  EXPECT_EQ(formats().open_device("/dev/null"), nullptr);
  EXPECT_EQ(formats().open_film("absent/film.mp4", "mp4v", 10, {64, 48}), nullptr);
}

TEST(Formats, AFilmIsReadBackFrameByFrame) {
  const TemporaryFolder folder;
  const std::string file = folder / "film.mp4";
  const auto shade = [](int frame) { return 40.0 * frame; };
  {
    const auto film = formats().open_film(file, "mp4v", 10, {64, 48});
    ASSERT_NE(film, nullptr);
    for (int frame = 0; frame < 5; ++frame)
      film->write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(shade(frame))));
  }
  const auto video = formats().open_file(file);
  ASSERT_NE(video, nullptr);
  ASSERT_TRUE(video->skip());
  cv::Mat frame;
  for (int i = 1; i < 5; ++i) {
    ASSERT_TRUE(video->read(frame));
    EXPECT_EQ(frame.size(), cv::Size(64, 48));
    EXPECT_NEAR(cv::mean(frame)[0], shade(i), 4) << i;
    EXPECT_NEAR(video->position(), 0.1 * i, 0.11) << i;
  }
  EXPECT_FALSE(video->read(frame));
}

}  // namespace
}  // namespace understudy::vision
