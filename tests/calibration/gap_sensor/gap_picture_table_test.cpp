#include "calibration/gap_sensor/gap_picture_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/calibration/gap_sensor/drawn_dots.h"

namespace understudy::calibration {
namespace {

using testing::HasSubstr;

const std::string kHeader = "height_mm,picture,gap_mm,gap_sigma_um\n";
const std::string kFive = "0.1,a.png,0.1,5\n0.3,b.png,,\n0.5,c.png,,\n0.7,d.png,,\n0.9,e.png,,\n";

class GapPictureTableFile : public DotFolder {
 protected:
  GapPictureTable read(const std::string& text) const { return read_gap_pictures(write("t.csv", text)); }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("t.csv"));
    }
    return "accepted";
  }
};

TEST_F(GapPictureTableFile, ReadsHeightsPicturesAndKnownGaps) {
  const GapPictureTable table = read("# by hand\n" + kHeader + kFive);
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_EQ(table.rows[1].line, 4);
  EXPECT_DOUBLE_EQ(table.rows[1].height, 0.3e-3);
  EXPECT_EQ(table.rows[1].file, (folder_ / "b.png").string());
  ASSERT_EQ(table.known.size(), 1u);
  EXPECT_DOUBLE_EQ(table.known[0].gap, 0.1e-3);
  EXPECT_DOUBLE_EQ(table.known[0].sigma, 5e-6);
  EXPECT_EQ(table.slopes, std::vector<Vec2>{Vec2::Zero()});
  EXPECT_EQ(table.sha256.size(), 64u);
}

TEST_F(GapPictureTableFile, AWedgeIsAnotherFlatWithAZeroOfItsOwn) {
  const GapPictureTable table = read(
      "height_mm,picture,gap_mm,gap_sigma_um,tilt_deg,azimuth_deg,height_sigma_um\n"
      "0.1,a.png,0.1,5,,,2\n0.3,b.png,,,0,0,2\n0.5,c.png,,,,,\n0.7,d.png,,,,,\n0.9,e.png,,,,,\n"
      "-3,f.png,0.4,5,30,90,2\n-2.8,g.png,,,30,90,\n");
  ASSERT_EQ(table.slopes.size(), 2u);
  // The normal leans towards +y: the flat falls that way.
  EXPECT_NEAR(table.slopes[1].y(), -std::tan(from_deg(30)), 1e-12);
  EXPECT_EQ(table.rows[6].flat, 1);
  EXPECT_EQ(table.known[1].flat, 1);
  EXPECT_DOUBLE_EQ(table.rows[0].height_sigma, 2e-6);
  EXPECT_EQ(table.rows[2].height_sigma, 0);
}

TEST_F(GapPictureTableFile, RefusesInOneLineWithPlaceValueAndLimit) {
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = kHeader + kFive;
    return refusal(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(refusal(""), HasSubstr("t.csv: is empty"));
  EXPECT_EQ(refused("picture,", "pictures,"), "t.csv:1: unknown column 'pictures', did you mean 'picture'?");
  EXPECT_EQ(refused(",gap_sigma_um", ",gap_mm"), "t.csv:1: column 'gap_mm' is given twice");
  EXPECT_EQ(refusal("height_mm,picture,gap_mm\n"), "t.csv:1: missing column gap_sigma_um");
  EXPECT_EQ(refused("gap_sigma_um\n", "gap_sigma_um,tilt_deg\n"),
            "t.csv:1: tilt_deg and azimuth_deg need each other");
  EXPECT_EQ(refused("0.3,b.png,,", "0.3,b.png,"), "t.csv:3: 3 cells, not 4");
  EXPECT_EQ(refused("0.3,b", "high,b"), "t.csv:3:1: height_mm is 'high', not a finite number");
  EXPECT_EQ(refused("0.3,b", "300,b"), "t.csv:3:1: height_mm is 300, outside -50 to 50");
  EXPECT_EQ(refused("a.png,0.1,5", "a.png,7,5"), "t.csv:2:11: gap_mm is 7, outside 0 to 5");
  EXPECT_EQ(refused("a.png,0.1,5", "a.png,0.1,0"), "t.csv:2:15: gap_sigma_um is 0, outside 0.1 to 1000");
  EXPECT_EQ(refused("a.png,0.1,5", "a.png,0.1,"), "t.csv:2: gap_mm and gap_sigma_um need each other");
  EXPECT_EQ(refused("b.png", ""), "t.csv:3: has neither a picture nor a gap_mm");
  EXPECT_EQ(refused("b.png", "a.png"), "t.csv:3: picture 'a.png' is that of line 2, too");
  EXPECT_EQ(refused("a.png,0.1,5", "a.png,,"), "t.csv: no row has a gap_mm: at least one gap must be known");
  EXPECT_EQ(refused("0.9,e.png,,\n", ""),
            "t.csv: pictures at 4 heights over one flat, at least 5 are needed");
  EXPECT_EQ(refused("0.9,e", "0.1,e"), "t.csv: pictures at 4 heights over one flat, at least 5 are needed");
  EXPECT_EQ(refusal(kHeader + "0.1,a,0.1,5\n0.2,b,,\n0.3,c,,\n0.4,d,,\n0.5,e,,\n"),
            "t.csv: the heights of the pictures spread over 0.400 mm, at least 0.5 mm are needed");
  EXPECT_EQ(refused("0.9,e", "9,e"),
            "t.csv:6: height_mm is 9: by the known gap of 0.1 mm at 0.1 mm that is a gap of 9.000 mm, "
            "outside -0.02 "
            "to 8 mm");
  EXPECT_EQ(refused("a.png,0.1,5", "a.png,0.1,5\n0.1,,3.9,5\n0.1,,4,5"), "accepted");  // the fit will say so
}

}  // namespace
}  // namespace understudy::calibration
