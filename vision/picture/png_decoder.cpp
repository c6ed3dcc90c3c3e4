#include "vision/picture/png_decoder.h"

#include <csetjmp>
#include <cstring>
#include <vector>

#include <png.h>

namespace understudy::vision {
namespace {

struct Unread {
  const char* at;
  std::size_t size;
};

void read_bytes(png_structp png, png_bytep to, std::size_t size) {
  auto& unread = *static_cast<Unread*>(png_get_io_ptr(png));
  if (size > unread.size) png_error(png, "cut short");
  std::memcpy(to, unread.at, size);
  unread.at += size;
  unread.size -= size;
}

/// Without a word on standard error.
void leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore(png_structp, png_const_charp) {}

/// Asks for 8-bit grey, whatever the file has.
void ask_for_grey(png_structp png, png_infop info) {
  constexpr double kRed = 0.299, kGreen = 0.587;
  png_set_strip_16(png);
  png_set_strip_alpha(png);
  const auto kind = png_get_color_type(png, info);
  if (kind == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (kind == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
  if ((kind & PNG_COLOR_MASK_COLOR) != 0) png_set_rgb_to_gray(png, PNG_ERROR_ACTION_NONE, kRed, kGreen);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

// libpng leaves by a jump: below a setjmp nothing may need a destructor, so what is to live lies outside of
// it.
bool read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  ask_for_grey(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

Image read_image(png_structp png, png_infop info) {
  if (!read_header(png, info)) return {};
  const auto width = static_cast<int>(png_get_image_width(png, info));
  const auto height = static_cast<int>(png_get_image_height(png, info));
  const std::size_t step = png_get_rowbytes(png, info);
  if (step != static_cast<std::size_t>(width)) return {};
  Image image{{0, 0, width, height}, std::vector<std::uint8_t>(step * static_cast<std::size_t>(height))};
  std::vector<png_bytep> rows;
  for (std::size_t at = 0; at < image.pixels.size(); at += step) rows.push_back(image.pixels.data() + at);
  return read_rows(png, rows.data()) ? image : Image{};
}

}  // namespace

bool is_png(const std::string& bytes) { return bytes.compare(0, 4, "\x89PNG") == 0; }

Image decode_png(const std::string& bytes) {
  Unread unread{bytes.data(), bytes.size()};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, &leave, &ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Image image;
  if (info) {
    png_set_read_fn(png, &unread, &read_bytes);
    image = read_image(png, info);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return image;
}

}  // namespace understudy::vision
