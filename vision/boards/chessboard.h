// Sub-pixel corners of the printed chessboard (Song 2015, appendix B.1; docs/reference.md#two-cameras).
#pragma once

#include <vector>

#include "core/image.h"
#include "vision/boards/calibration_rig.h"

namespace understudy::vision {

enum class BoardStatus {
  ok,
  no_board,
  partly_out_of_view,  ///< corners of a chessboard are there, but not all of them
  overexposed,
  too_dark,
  wrongly_turned,  ///< upside down or lying on its side
};
const char* to_string(BoardStatus s);

struct BoardOptions {
  double saturated_fraction_max = 0.05;  ///< of the pixels of the board at 255
  double contrast_min = 40;              ///< grey levels of paper over ink
};

struct BoardMeasurement {
  BoardStatus status = BoardStatus::no_board;
  std::vector<Vec2>
      corners_px;         ///< in the order of Board::corner, on the sensor (the image's region is added)
  double scatter_px = 0;  ///< 1 sigma of a corner in u or v, from third differences along rows and columns
  double contrast = 0;    ///< grey levels
  double saturated_fraction = 0;
  int corners_seen = 0;  ///< when not all are found: how many places look like a corner
};

/// Corners are where both edges' gradients are orthogonal to the line to them, in windows of 13 x 13 px
/// (OpenCV's findChessboardCorners and cornerSubPix). The board must have one even and one odd count of inner
/// corners. Never throws for what a picture holds; a board that looks the same upside down is
/// InputError.
BoardMeasurement measure_board(const Image& image, const Board& board, const BoardOptions& options = {});

}  // namespace understudy::vision
