#include "vision/picture/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::vision {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

/// What is read of a file with these bytes.
Image read_bytes(const std::string& bytes) {
  const TemporaryFolder folder;
  const auto path = folder / "picture.png";
  write_file(path, bytes);
  return read_picture(path.string());
}

std::string refusal(const std::string& bytes) {
  try {
    read_bytes(bytes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "read";
}

// Written by hand from the PNG specification: signature, IHDR, IDAT, IEND.
TEST(PictureFile, AGreyPngKeepsItsLevels) {
  const Image image = read_bytes(from_hex(
      "89504e470d0a1a0a0000000d4948445200000003000000020800000000b81f39c6000000104944415478da636048f9cfc0ce"
      "c109000789017c1b5a55960000000049454e44ae426082"));
  EXPECT_EQ(image.region, (Region{0, 0, 3, 2}));
  EXPECT_THAT(image.pixels, ElementsAre(0, 100, 255, 7, 8, 9));
}

// A red pixel; luminance of ITU-R BT.601: 0.299 of 255 is 76.2.
TEST(PictureFile, ColourIsReadByItsLuminanceAndSixteenBitsByTheUpperEight) {
  const Image red = read_bytes(from_hex(
      "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c4944415478da63f8cfc0000003"
      "010100f70341430000000049454e44ae426082"));
  ASSERT_EQ(red.pixels.size(), 1u);
  EXPECT_NEAR(red.pixels[0], 76.2, 0.8);
  const Image deep = read_bytes(from_hex(
      "89504e470d0a1a0a0000000d49484452000000010000000110000000006aee47160000000b4944415478da6368700000014300"
      "c1cc70e2ea0000000049454e44ae426082"));
  EXPECT_THAT(deep.pixels, ElementsAre(0x80));
}

TEST(PictureFile, WhatIsNoPictureIsRefusedByName) {
  EXPECT_THAT(refusal(""), HasSubstr("picture.png: holds no picture"));
  EXPECT_THAT(refusal("x_mm,y_mm\n1,2\n"), HasSubstr("holds no picture"));
  EXPECT_THAT(refusal(from_hex("89504e470d0a1a0a0000000d49484452")), HasSubstr("holds no picture"));
  // 65535 x 65535 px in 67 bytes.
  EXPECT_THAT(refusal(from_hex(
                  "89504e470d0a1a0a0000000d494844520000ffff0000ffff0800000000936e868c0000000a4944415478da"
                  "6360000000020001e527defc0000000049454e44ae426082")),
              HasSubstr("4294836225 pixels, must have at most 100000000"));
  EXPECT_THROW(read_picture("absent.png"), InputError);
}

}  // namespace
}  // namespace understudy::vision
