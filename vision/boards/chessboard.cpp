#include "vision/boards/chessboard.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "vision/dot/grey_levels.h"

namespace understudy::vision {
namespace {

constexpr int kSearchWidth = 800;  // [px]: squares of 50 px are found as surely as larger ones, and sooner
constexpr int kWindow = 6;         // [px], half of the window of cornerSubPix

using Corners = std::vector<cv::Point2f>;

/// Rough corners, found in a picture reduced by whole pixels.
bool find_corners(const cv::Mat& picture, const Board& board, Corners& corners) {
  const int factor = std::max(1, (picture.cols + kSearchWidth - 1) / kSearchWidth);
  cv::Mat small = picture;
  if (factor > 1) {
    cv::resize(picture, small, {picture.cols / factor, picture.rows / factor}, 0, 0, cv::INTER_AREA);
  }
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  if (!cv::findChessboardCorners(small, {board.columns, board.rows}, corners, flags)) return false;
  const auto f = static_cast<float>(factor);
  for (cv::Point2f& c : corners) c = {f * (c.x + 0.5f) - 0.5f, f * (c.y + 0.5f) - 0.5f};
  return corners.size() == static_cast<std::size_t>(board.corners());
}

/// Places where the second derivatives say saddle: the corners of any chessboard, whole or not.
int count_saddles(const cv::Mat& picture, double contrast) {
  const int factor = std::max(1, (picture.cols + kSearchWidth - 1) / kSearchWidth);
  cv::Mat small, smooth, xx, yy, xy;
  cv::resize(picture, small, {picture.cols / factor, picture.rows / factor}, 0, 0, cv::INTER_AREA);
  small.convertTo(smooth, CV_32F);
  constexpr double kSigma = 3;
  cv::GaussianBlur(smooth, smooth, {}, kSigma);
  cv::Sobel(smooth, xx, CV_32F, 2, 0, 3, 0.25);
  cv::Sobel(smooth, yy, CV_32F, 0, 2, 3, 0.25);
  cv::Sobel(smooth, xy, CV_32F, 1, 1, 3, 0.25);
  const cv::Mat saddle = xy.mul(xy) - xx.mul(yy);
  cv::Mat highest;
  cv::dilate(saddle, highest, cv::getStructuringElement(cv::MORPH_RECT, {15, 15}));
  // A blurred corner of this contrast has a mixed derivative of contrast / (pi sigma^2).
  const double expected = contrast / (3.14159265 * kSigma * kSigma);
  return cv::countNonZero((saddle >= highest) & (saddle > 0.25 * expected * expected));
}

/// The first corner to the upper left; false when the columns do not run to the right or the left.
bool upright(Corners& corners, const Board& board) {
  const cv::Point2f along = corners[static_cast<std::size_t>(board.columns - 1)] - corners.front();
  if (std::abs(along.x) < 2 * std::abs(along.y)) return false;
  if (along.x < 0) std::reverse(corners.begin(), corners.end());
  const cv::Point2f down = corners.back() - corners[static_cast<std::size_t>(board.columns - 1)];
  return down.y > 0;
}

/// Whether the square above and to the left of the first corner is inked, as on a board the right way up.
bool first_square_is_dark(const cv::Mat& picture, const Corners& corners, const Board& board) {
  const cv::Point2f first = corners.front();
  const cv::Point2f across = 0.5f * (corners[1] - first);
  const cv::Point2f down = 0.5f * (corners[static_cast<std::size_t>(board.columns)] - first);
  const auto level = [&](const cv::Point2f& p) {
    const int x = std::clamp(cvRound(p.x), 0, picture.cols - 1);
    const int y = std::clamp(cvRound(p.y), 0, picture.rows - 1);
    return static_cast<int>(picture.at<std::uint8_t>(y, x));
  };
  return level(first - across - down) + level(first + across + down) <
         level(first + across - down) + level(first - across + down);
}

/// Third differences see neither perspective nor lens (up to 0.01 px), only scatter: variance 20 sigma^2.
double scatter(const std::vector<Vec2>& corners, const Board& board) {
  double sum = 0;
  int count = 0;
  const auto add = [&](int first, int step) {
    const auto at = [&](int i) { return corners[static_cast<std::size_t>(first + i * step)]; };
    sum += (at(3) - 3 * at(2) + 3 * at(1) - at(0)).squaredNorm();
    count += 2;
  };
  for (int r = 0; r < board.rows; ++r) {
    for (int c = 0; c < board.columns; ++c) {
      if (c + 3 < board.columns) add(r * board.columns + c, 1);
      if (r + 3 < board.rows) add(r * board.columns + c, board.columns);
    }
  }
  return count > 0 ? std::sqrt(sum / (20.0 * count)) : 0;
}

BoardStatus reason_for_none(const cv::Mat& picture, const BoardOptions& options, BoardMeasurement& m) {
  if (m.saturated_fraction > 0.5) return BoardStatus::overexposed;
  if (m.contrast < options.contrast_min) {
    return m.saturated_fraction > options.saturated_fraction_max ? BoardStatus::overexposed
                                                                 : BoardStatus::too_dark;
  }
  m.corners_seen = count_saddles(picture, m.contrast);
  return m.corners_seen >= 4 ? BoardStatus::partly_out_of_view : BoardStatus::no_board;
}

}  // namespace

const char* to_string(BoardStatus s) {
  switch (s) {
    case BoardStatus::ok:
      return "ok";
    case BoardStatus::no_board:
      return "no chessboard is in the picture";
    case BoardStatus::partly_out_of_view:
      return "the chessboard is partly out of view";
    case BoardStatus::overexposed:
      return "the chessboard's picture is overexposed";
    case BoardStatus::too_dark:
      return "the chessboard's picture has too little contrast";
    case BoardStatus::wrongly_turned:
      return "the chessboard is upside down or on its side";
  }
  return "unknown";
}

BoardMeasurement measure_board(const Image& image, const Board& board, const BoardOptions& options) {
  if (board.columns < 3 || board.rows < 3 || (board.columns + board.rows) % 2 == 0) {
    throw InputError("chessboard: " + std::to_string(board.columns) + " x " + std::to_string(board.rows) +
                     " inner corners, must be 3 or more, one of them odd and one even");
  }
  BoardMeasurement m;
  if (!has_pixels(image)) return m;
  cv::setNumThreads(1);
  const cv::Mat picture(image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  const GreyLevels whole = grey_levels(image);
  m.contrast = whole.bright - whole.dark;
  m.saturated_fraction = whole.saturated_fraction;

  Corners corners;
  if (m.contrast < options.contrast_min || !find_corners(picture, board, corners)) {
    m.status = reason_for_none(picture, options, m);
    return m;
  }
  m.corners_seen = board.corners();
  if (!upright(corners, board) || !first_square_is_dark(picture, corners, board)) {
    m.status = BoardStatus::wrongly_turned;
    return m;
  }
  cv::cornerSubPix(picture, corners, {kWindow, kWindow}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3});
  for (const cv::Point2f& c : corners) {
    m.corners_px.push_back(
        Vec2(c.x + static_cast<float>(image.region.x), c.y + static_cast<float>(image.region.y)));
  }
  m.scatter_px = scatter(m.corners_px, board);
  m.status =
      m.saturated_fraction > options.saturated_fraction_max ? BoardStatus::overexposed : BoardStatus::ok;
  return m;
}

}  // namespace understudy::vision
