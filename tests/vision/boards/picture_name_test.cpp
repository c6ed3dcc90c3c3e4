#include "vision/boards/picture_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::vision {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Optional;

const std::vector<std::string> kWords{"camera", "layer"};

TEST(PictureName, WritesNumbersAndReadsThemBack) {
  const PictureName name("boards/camera{camera}-layer{layer:02}.png", kWords);
  EXPECT_EQ(name.name({1, 7}), "boards/camera1-layer07.png");
  EXPECT_EQ(name.name({0, 123}), "boards/camera0-layer123.png");
  EXPECT_THAT(name.numbers("boards/camera1-layer07.png"), Optional(ElementsAre(1, 7)));
  EXPECT_THAT(name.numbers("/elsewhere/camera0-layer123.png"), Optional(ElementsAre(0, 123)));
  EXPECT_THAT(name.numbers("camera0-layer00.png"), Optional(ElementsAre(0, 0)));
}

TEST(PictureName, TheOrderOfTheWordsInThePatternIsFree) {
  const PictureName name("{layer}_of_{camera}.jpg", kWords);
  EXPECT_EQ(name.name({1, 7}), "7_of_1.jpg");
  EXPECT_THAT(name.numbers("7_of_1.jpg"), Optional(ElementsAre(1, 7)));
}

TEST(PictureName, AnotherNameHasNoNumbers) {
  const PictureName name("camera{camera}-layer{layer:02}.png", kWords);
  for (const char* other :
       {"", "camera1-layer7.png", "camera1-layer07.jpg", "xcamera1-layer07.png", "camera1-layer07.png~",
        "camera-layer07.png", "camera1-layer1234567.png", "camera1"})
    EXPECT_FALSE(name.numbers(other)) << other;
  EXPECT_FALSE(PictureName().numbers("camera1-layer07.png"));
}

TEST(PictureName, APatternThatCannotBeReadBackIsRefused) {
  const auto message = [](const std::string& pattern) -> std::string {
    try {
      PictureName(pattern, kWords);
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("camera{camera}.png"), HasSubstr("{layer} is missing"));
  EXPECT_THAT(message("{camera}-{camera}-{layer}"), HasSubstr("{camera} occurs twice"));
  EXPECT_THAT(message("{camera}{layer}"), HasSubstr("{layer} follows another number"));
  EXPECT_THAT(message("0{camera}-{layer}"), HasSubstr("{camera} follows another number"));
  EXPECT_THAT(message("{camera}1-{layer}"), HasSubstr("{camera} is followed by a digit"));
  EXPECT_THAT(message("{camera}/{layer}"), HasSubstr("{camera} is in a folder's name"));
  EXPECT_THAT(message("{camera}-{depth}"), HasSubstr("{depth} is not one of {camera}, {layer}"));
  EXPECT_THAT(message("{camera}-{layer:9}"), HasSubstr(":01 to :06"));
  EXPECT_THAT(message("{camera}-{layer"), HasSubstr("a { has no }"));
}

}  // namespace
}  // namespace understudy::vision
