#include "report/picture/placement_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "report/picture/picture_text.h"
#include "report/picture/workspace_drawing.h"

namespace understudy::report {
namespace {

using rehearsal::PlacementMap;

constexpr int kWidth = 1000, kHeight = 940, kLeft = 120, kTop = 130, kSide = 720;

/// From pale to strong red: a little and far beyond a limit.
Rgb broken_colour(double margin) {
  constexpr std::array<double, 3> kPale{250, 215, 205}, kDeep{200, 60, 40};
  const double t = std::clamp(-margin, 0.0, 1.0);
  Rgb colour;
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(std::lround(kPale[i] + t * (kDeep[i] - kPale[i])));
  return colour;
}

Rgb colour_of(double margin) { return margin >= 0 ? margin_colour(margin) : broken_colour(margin); }

cv::Mat cells(const PlacementMap& map) {
  cv::Mat pixels(map.rows, map.columns, CV_8UC3);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const Rgb c =
          colour_of(map.margin[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.columns) +
                               static_cast<std::size_t>(column)]);
      pixels.at<cv::Vec3b>(map.rows - 1 - row, column) = {c[2], c[1], c[0]};
    }
  return pixels;
}

void draw_axes(cv::Mat& canvas, const PlacementMap& map, const cv::Rect& plot) {
  const double last_x = map.x_mm + (map.columns - 1) * map.x_step_mm;
  const double last_y = map.y_mm + (map.rows - 1) * map.y_step_mm;
  const int bottom = plot.y + plot.height + 28, beside = plot.x - 10;
  const auto number = [](double v) { return fmt::format("{:.4g}", std::round(1e6 * v) / 1e6 + 0.0); };
  const auto half_cell = [](int pixels, int count) { return pixels / (2 * count); };
  const int x_half = half_cell(plot.width, map.columns), y_half = half_cell(plot.height, map.rows);
  write(canvas, number(map.x_mm), {plot.x + x_half, bottom}, 0.55, kInk, Align::centre);
  write(canvas, "x of the print's middle, mm", {plot.x + plot.width / 2, bottom}, 0.55, kInk, Align::centre);
  write(canvas, number(last_x), {plot.x + plot.width - x_half, bottom}, 0.55, kInk, Align::centre);
  write(canvas, number(last_y), {beside, plot.y + y_half + 6}, 0.55, kInk, Align::right);
  write(canvas, "y, mm", {beside, plot.y + plot.height / 2}, 0.55, kInk, Align::right);
  write(canvas, number(map.y_mm), {beside, plot.y + plot.height - y_half + 6}, 0.55, kInk, Align::right);
}

void draw_answer(cv::Mat& canvas, const PlacementMap& map, const cv::Rect& plot) {
  const double x = ((map.best_x_mm - map.x_mm) / map.x_step_mm + 0.5) / map.columns;
  const double y = ((map.best_y_mm - map.y_mm) / map.y_step_mm + 0.5) / map.rows;
  const cv::Point at(plot.x + static_cast<int>(std::lround(x * plot.width)),
                     plot.y + static_cast<int>(std::lround((1 - y) * plot.height)));
  cv::drawMarker(canvas, at, kPaper, cv::MARKER_CROSS, 34, 7);
  cv::drawMarker(canvas, at, kInk, cv::MARKER_CROSS, 30, 3);
}

void draw_scale(cv::Mat& canvas, cv::Point at) {
  constexpr int kBar = 260, kThick = 24;
  for (int y = 0; y < kBar; ++y) {
    const Rgb c = colour_of(1 - 2 * (y + 0.5) / kBar);
    cv::line(canvas, {at.x, at.y + y}, {at.x + kThick, at.y + y}, cv::Scalar(c[2], c[1], c[0]));
  }
  write(canvas, "1", {at.x + kThick + 10, at.y + 10}, 0.55);
  write(canvas, "0 limit", {at.x + kThick + 10, at.y + kBar / 2 + 6}, 0.55);
  write(canvas, "broken", {at.x + kThick + 10, at.y + kBar}, 0.55);
}

}  // namespace

renderer::Picture placement_picture(const rehearsal::Placement& placement, const std::string& title) {
  const PlacementMap& map = placement.map;
  cv::Mat canvas(kHeight, kWidth, CV_8UC3, kPaper);
  const double scale = kSide / std::max(map.columns * map.x_step_mm, map.rows * map.y_step_mm);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * map.columns * map.x_step_mm))),
                      std::max(1, static_cast<int>(std::lround(scale * map.rows * map.y_step_mm))));
  const cv::Rect plot({kLeft, kTop}, size);
  cv::Mat enlarged;
  cv::resize(cells(map), enlarged, size, 0, 0, cv::INTER_NEAREST);
  enlarged.copyTo(canvas(plot));
  cv::rectangle(canvas, {plot.x - 1, plot.y - 1, plot.width + 2, plot.height + 2}, kInk, 1);
  draw_axes(canvas, map, plot);
  draw_answer(canvas, map, plot);
  draw_scale(canvas, {kLeft + kSide + 24, kTop});
  write(canvas, "Where to put " + title, {36, 46}, 0.9);
  write(canvas,
        placement.possible
            ? fmt::format("margin {:.3f} ({}) with {}", placement.margin, placement.least,
                          rehearsal::place_words(placement.place))
            : "no place holds every limit; the best: " + rehearsal::place_words(placement.place),
        {36, 82}, 0.6, kFaint);
  cv::cvtColor(canvas, canvas, cv::COLOR_BGR2RGB);
  return {kWidth, kHeight, {canvas.datastart, canvas.dataend}};
}

}  // namespace understudy::report
