#include "vision/picture/picture_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "core/error.h"
#include "core/file/read_file.h"

namespace understudy::vision {
namespace {

constexpr std::uint64_t kMostPixels = 100'000'000;

constexpr std::size_t kSignature = 8, kChunkFrame = 12;  // of a PNG: bytes of length, name and check sum

bool is_png(const std::string& bytes) { return bytes.compare(0, 4, "\x89PNG") == 0; }

/// Big-endian, as PNG has it.
std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Whether a PNG has all of its chunks: the decoder would complain of a cut one on standard error.
bool is_whole(const std::string& bytes) {
  std::size_t at = kSignature;
  while (at + kChunkFrame <= bytes.size()) {
    if (bytes.compare(at + 4, 4, "IEND") == 0) return true;
    at += kChunkFrame + number_at(bytes, at);
  }
  return false;
}

/// Pixels that a whole PNG says it has: its header can promise more than memory holds.
std::uint64_t promised_pixels(const std::string& bytes) {
  constexpr std::size_t kWidth = 16, kHeaderEnd = 24;
  return bytes.size() < kHeaderEnd ? 0 : number_at(bytes, kWidth) * number_at(bytes, kWidth + 4);
}

cv::Mat decode(const std::string& bytes) {
  if (bytes.empty() || (is_png(bytes) && !is_whole(bytes))) return {};
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  try {
    return cv::imdecode(raw, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

Image read_picture(const std::string& file) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // it would write to standard error
  const std::string bytes = read_file(file);
  if (is_png(bytes) && promised_pixels(bytes) > kMostPixels)
    throw InputError({file, 0, 0}, "is a picture of " + std::to_string(promised_pixels(bytes)) +
                                       " pixels, must have at most " + std::to_string(kMostPixels));
  const cv::Mat picture = decode(bytes);
  if (picture.empty())
    throw InputError({file, 0, 0}, "holds no picture that can be read: PNG, JPEG, TIFF or BMP");
  Image image{{0, 0, picture.cols, picture.rows}, {}};
  image.pixels.reserve(picture.total());
  for (int y = 0; y < picture.rows; ++y)
    image.pixels.insert(image.pixels.end(), picture.ptr(y), picture.ptr(y) + picture.cols);
  return image;
}

}  // namespace understudy::vision
