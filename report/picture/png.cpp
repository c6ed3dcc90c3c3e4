#include "report/picture/png.h"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>

namespace understudy::report {
namespace {

std::string encode(const cv::Mat& pixels, cv::ImwritePNGFlags strategy) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", pixels, bytes,
                    {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, strategy}))
    throw std::logic_error("OpenCV has no PNG encoder");
  return {bytes.begin(), bytes.end()};
}

void require_pixels(std::size_t have, int width, int height, int channels) {
  const bool fits = width > 0 && height > 0 &&
                    have == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                static_cast<std::size_t>(channels);
  if (!fits)
    throw std::logic_error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                           " px cannot have " + std::to_string(have) + " bytes");
}

}  // namespace

std::string encode_png(const Image& grey) {
  require_pixels(grey.pixels.size(), grey.width(), grey.height(), 1);
  cv::Mat pixels(grey.height(), grey.width(), CV_8UC1);
  std::copy(grey.pixels.begin(), grey.pixels.end(), pixels.data);
  // In a sensor's noise there are no repetitions to look for: that takes eight times as long for a larger
  // file.
  return encode(pixels, cv::IMWRITE_PNG_STRATEGY_RLE);
}

std::string encode_png(const renderer::Picture& picture) {
  require_pixels(picture.rgb.size(), picture.width, picture.height, 3);
  cv::Mat pixels(picture.height, picture.width, CV_8UC3);
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {  // OpenCV keeps blue first
    pixels.data[i] = picture.rgb[i + 2];
    pixels.data[i + 1] = picture.rgb[i + 1];
    pixels.data[i + 2] = picture.rgb[i];
  }
  return encode(pixels, cv::IMWRITE_PNG_STRATEGY_DEFAULT);
}

std::string base64(const std::string& bytes) {
  static const char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kAlphabet[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

}  // namespace understudy::report
