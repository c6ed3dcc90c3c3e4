// Drawn boards; those that a renderer makes are in rendered_boards_test.cpp.
#include "vision/boards/chessboard.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/vision/boards/drawn_picture.h"

namespace understudy::vision {
namespace {

const Board kBoard{7, 4, 10e-3, 2.5e-3};
constexpr double kSquare = 40;  // [px]
const Vec2 kFirst(70.3, 80.8);

Image board_picture() { return drawn_board(400, 300, kBoard, kFirst, kSquare); }

// The finder's gradients are differences over whole pixels, so its error depends on where in a pixel an edge
// lies: 0.11 px for edges that are drawn sharp, and less the wider they are. Behind a lens 8 bits and the
// finder leave under 0.03 px RMS, as in rendered pictures; an error that goes up and down with the place has
// at most sqrt(2) times that.
TEST(Chessboard, CornersOfADrawnBoardAreWhereTheSquaresMeetWhereverInAPixelThatIs) {
  constexpr double kRms = 0.03;
  double squares = 0;
  int count = 0;
  for (const Vec2& place : {kFirst, Vec2(70, 80), Vec2(70.5, 80.5), Vec2(70.1, 80.25), Vec2(70.75, 80.6)}) {
    const BoardMeasurement m = measure_board(drawn_board(400, 300, kBoard, place, kSquare), kBoard);
    ASSERT_EQ(m.status, BoardStatus::ok) << to_string(m.status);
    ASSERT_EQ(m.corners_px.size(), 28u);
    for (int row = 0; row < kBoard.rows; ++row)
      for (int column = 0; column < kBoard.columns; ++column, ++count) {
        const Vec2 truth = place + kSquare * Vec2(column, row);
        const double miss =
            (m.corners_px[static_cast<std::size_t>(row * kBoard.columns + column)] - truth).norm();
        EXPECT_LE(miss, std::numbers::sqrt2 * kRms) << column << ", " << row << " of " << place.transpose();
        squares += miss * miss;
      }
    EXPECT_EQ(m.contrast, kPaper - kInk);
  }
  EXPECT_LE(std::sqrt(squares / count), kRms);
}

TEST(Chessboard, TheRegionsPlaceOnTheSensorIsAdded) {
  Image image = board_picture();
  const Vec2 here = measure_board(image, kBoard).corners_px.front();
  image.region.x = 500;
  image.region.y = 300;
  EXPECT_LE((measure_board(image, kBoard).corners_px.front() - here - Vec2(500, 300)).norm(), 1e-3);
}

TEST(Chessboard, UpsideDownOrOnItsSideItIsRefused) {
  Image turned = board_picture();
  std::reverse(turned.pixels.begin(), turned.pixels.end());
  EXPECT_EQ(measure_board(turned, kBoard).status, BoardStatus::wrongly_turned);
  const Board on_its_side{4, 7, 10e-3, 2.5e-3};
  EXPECT_EQ(measure_board(drawn_board(300, 400, on_its_side, Vec2(80.3, 70.8), kSquare), kBoard).status,
            BoardStatus::wrongly_turned);
}

TEST(Chessboard, WithoutABoardTheReasonIsGiven) {
  EXPECT_EQ(measure_board(Image{}, kBoard).status, BoardStatus::no_board);
  const auto plain = [](double level) {
    return drawn_picture(200, 150, [=](double, double) { return level; });
  };
  EXPECT_EQ(measure_board(plain(20), kBoard).status, BoardStatus::too_dark);
  EXPECT_EQ(measure_board(plain(255), kBoard).status, BoardStatus::overexposed);
  EXPECT_EQ(measure_board(drawn_discs(200, 150, {{Vec2(100, 75), 40}}), kBoard).status,
            BoardStatus::no_board);
  EXPECT_EQ(measure_board(drawn_board(400, 300, kBoard, Vec2(250, 80), kSquare), kBoard).status,
            BoardStatus::partly_out_of_view);
}

TEST(Chessboard, ABoardThatLooksTheSameUpsideDownIsAnInputError) {
  EXPECT_THROW(measure_board(board_picture(), Board{6, 4, 10e-3, 2.5e-3}), InputError);
  EXPECT_THROW(measure_board(board_picture(), Board{7, 2, 10e-3, 2.5e-3}), InputError);
}

}  // namespace
}  // namespace understudy::vision
