#include "report/picture/png.h"

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <stdexcept>

#include <png.h>
#include <zlib.h>

namespace understudy::report {
namespace {

struct Rows {
  const std::uint8_t* pixels;
  std::size_t step;  // [bytes]
  int width, height, colours;
};

void append(png_structp png, png_bytep from, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(from), size);
}

void leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }

// libpng leaves by a jump: nothing here may need a destructor.
bool write_rows(png_structp png, png_infop info, const Rows& rows, int strategy) {
  constexpr int kCompression = 6, kDepth = 8;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_compression_level(png, kCompression);
  png_set_compression_strategy(png, strategy);
  png_set_IHDR(png, info, static_cast<png_uint_32>(rows.width), static_cast<png_uint_32>(rows.height), kDepth,
               rows.colours, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int y = 0; y < rows.height; ++y)
    png_write_row(png, rows.pixels + rows.step * static_cast<std::size_t>(y));
  png_write_end(png, info);
  return true;
}

std::string encode(const Rows& rows, int strategy) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &leave, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  bool written = false;
  if (info) {
    png_set_write_fn(png, &bytes, &append, nullptr);
    written = write_rows(png, info, rows, strategy);
  }
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::logic_error("libpng cannot write a picture");
  return bytes;
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
  // In a sensor's noise there are no repetitions to look for: that takes eight times as long for a larger
  // file.
  return encode({grey.pixels.data(), static_cast<std::size_t>(grey.width()), grey.width(), grey.height(),
                 PNG_COLOR_TYPE_GRAY},
                Z_RLE);
}

std::string encode_png(const renderer::Picture& picture) {
  require_pixels(picture.rgb.size(), picture.width, picture.height, 3);
  return encode({picture.rgb.data(), 3 * static_cast<std::size_t>(picture.width), picture.width,
                 picture.height, PNG_COLOR_TYPE_RGB},
                Z_DEFAULT_STRATEGY);
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
