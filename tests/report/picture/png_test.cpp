#include "report/picture/png.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace understudy::report {
namespace {

cv::Mat decode(const std::string& png) {
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
}

// RFC 4648, section 10.
TEST(Base64, GivesTheTestVectorsOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, KeepsBytesAbove127) { EXPECT_EQ(base64("\xff\xfe\xfd"), "//79"); }

TEST(Png, GreyPixelsComeBackUnchanged) {
  const Image image{{10, 20, 3, 2}, {0, 1, 127, 128, 254, 255}};
  const cv::Mat pixels = decode(encode_png(image));
  ASSERT_EQ(pixels.type(), CV_8UC1);
  ASSERT_EQ(pixels.size(), cv::Size(3, 2));
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) EXPECT_EQ(pixels.at<unsigned char>(y, x), image.at(x, y)) << x << "," << y;
}

TEST(Png, ColoursKeepTheirChannels) {
  const cv::Mat pixels = decode(encode_png(renderer::Picture{2, 1, {200, 100, 50, 1, 2, 3}}));
  ASSERT_EQ(pixels.type(), CV_8UC3);
  EXPECT_EQ(pixels.at<cv::Vec3b>(0, 0), cv::Vec3b(50, 100, 200));  // OpenCV: blue, green, red
  EXPECT_EQ(pixels.at<cv::Vec3b>(0, 1), cv::Vec3b(3, 2, 1));
}

TEST(Png, EqualPixelsGiveEqualBytes) {
  const renderer::Picture picture{64, 64, std::vector<std::uint8_t>(64 * 64 * 3, 77)};
  EXPECT_EQ(encode_png(picture), encode_png(picture));
}

TEST(Png, PixelsThatDoNotFillTheSizeAreOurOwnMistake) {
  EXPECT_THROW(encode_png(Image{{0, 0, 2, 2}, {1, 2, 3}}), std::logic_error);
  EXPECT_THROW(encode_png(renderer::Picture{0, 0, {}}), std::logic_error);
}

}  // namespace
}  // namespace understudy::report
