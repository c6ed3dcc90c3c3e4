// Pictures drawn from closed forms, so that the truth does not come from a renderer.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "core/calibration_rig.h"
#include "core/image.h"

namespace understudy::vision {

/// Each pixel is the mean of `level(u, v)` [grey levels] over its square, by 6 x 6 samples.
inline Image drawn_picture(int width, int height, const std::function<double(double, double)>& level) {
  constexpr int kSamples = 6;
  Image image{{0, 0, width, height}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i)
          sum += level(x + (i + 0.5) / kSamples - 0.5, y + (j + 0.5) / kSamples - 0.5);
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples))));
    }
  return image;
}

constexpr double kInk = 40, kPaper = 200;  // grey levels

/// A level chessboard whose first inner corner is at `first` [px], with squares of `square` [px]. The square
/// above and to the left of that corner is inked.
inline Image drawn_board(int width, int height, const Board& board, const Vec2& first, double square) {
  return drawn_picture(width, height, [&](double u, double v) {
    const double column = (u - first.x()) / square, row = (v - first.y()) / square;
    const bool on_board = column >= -1 && column < board.columns && row >= -1 && row < board.rows;
    const bool inked = (static_cast<int>(std::floor(column)) + static_cast<int>(std::floor(row))) % 2 == 0;
    return on_board && inked ? kInk : kPaper;
  });
}

struct Disc {
  Vec2 centre{0, 0};  ///< [px]
  double radius = 0;  ///< [px]
};

/// Dark discs before a bright backdrop.
inline Image drawn_discs(int width, int height, const std::vector<Disc>& discs) {
  return drawn_picture(width, height, [&](double u, double v) {
    for (const Disc& d : discs)
      if (std::hypot(u - d.centre.x(), v - d.centre.y()) <= d.radius) return kInk;
    return kPaper;
  });
}

}  // namespace understudy::vision
