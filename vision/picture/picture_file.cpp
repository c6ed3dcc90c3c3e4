#include "vision/picture/picture_file.h"

#include <cstddef>
#include <cstdint>

#include "core/error.h"
#include "core/file/read_file.h"
#include "vision/formats/formats.h"
#include "vision/picture/png_decoder.h"

namespace understudy::vision {
namespace {

constexpr std::uint64_t kMostPixels = 100'000'000;

/// Big-endian, as PNG has it.
std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Pixels that a PNG says it has: its header can promise more than memory holds.
std::uint64_t promised_pixels(const std::string& bytes) {
  constexpr std::size_t kWidth = 16, kHeaderEnd = 24;
  return bytes.size() < kHeaderEnd ? 0 : number_at(bytes, kWidth) * number_at(bytes, kWidth + 4);
}

Image image_of(const cv::Mat& picture) {
  Image image{{0, 0, picture.cols, picture.rows}, {}};
  image.pixels.reserve(picture.total());
  for (int y = 0; y < picture.rows; ++y)
    image.pixels.insert(image.pixels.end(), picture.ptr(y), picture.ptr(y) + picture.cols);
  return image;
}

}  // namespace

Image read_picture(const std::string& file) {
  const std::string bytes = read_file(file);
  if (is_png(bytes) && promised_pixels(bytes) > kMostPixels)
    throw InputError({file, 0, 0}, "is a picture of " + std::to_string(promised_pixels(bytes)) +
                                       " pixels, must have at most " + std::to_string(kMostPixels));
  Image image = is_png(bytes) ? decode_png(bytes) : image_of(formats().decode_grey(bytes));
  if (image.pixels.empty())
    throw InputError({file, 0, 0}, "holds no picture that can be read: PNG, JPEG, TIFF or BMP");
  return image;
}

}  // namespace understudy::vision
