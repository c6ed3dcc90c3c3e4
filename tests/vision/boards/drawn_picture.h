// Pictures drawn from closed forms, so that the truth does not come from a renderer.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/image.h"
#include "vision/boards/calibration_rig.h"

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

constexpr double kLensBlur = 0.7;  // [px], 1 sigma: sharper edges than a lens's alias

/// Mean over the pixel at `x` [px] of a step from -1 to 1 at 0 behind the lens, in closed form.
inline double blurred_step(double x) {
  const auto integral = [](double t) {
    const double z = t / (std::numbers::sqrt2 * kLensBlur);
    return t * std::erf(z) + kLensBlur * std::sqrt(2 / std::numbers::pi) * std::exp(-z * z);
  };
  return integral(x + 0.5) - integral(x - 0.5);
}

/// Along one axis of a chessboard: `wave` alternates between 1 and -1 at the inner corners, `inside` is 1 on
/// the board.
struct BoardProfile {
  std::vector<double> wave, inside;

  BoardProfile(int pixels, double first, double square, int corners) {
    for (int x = 0; x < pixels; ++x) {
      double level = 1;
      for (int k = 0; k < corners; ++k)
        level += (k % 2 == 0 ? -1 : 1) * (1 + blurred_step(x - first - square * k));
      wave.push_back(level);
      inside.push_back(0.5 * (blurred_step(x - first + square) - blurred_step(x - first - square * corners)));
    }
  }
};

/// A level chessboard as a lens draws it, whose first inner corner is at `first` [px], with squares of
/// `square` [px]. The square above and to the left of that corner is inked.
inline Image drawn_board(int width, int height, const Board& board, const Vec2& first, double square) {
  const BoardProfile along(width, first.x(), square, board.columns),
      down(height, first.y(), square, board.rows);
  Image image{{0, 0, width, height}, {}};
  for (std::size_t y = 0; y < down.wave.size(); ++y)
    for (std::size_t x = 0; x < along.wave.size(); ++x) {
      const double ink = 0.5 * (1 + along.wave[x] * down.wave[y]) * along.inside[x] * down.inside[y];
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(kPaper + (kInk - kPaper) * ink)));
    }
  return image;
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
