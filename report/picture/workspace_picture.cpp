// A view in space, what the colours mean, and four slices.
#include "report/picture/workspace_picture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "core/units.h"
#include "report/picture/picture_text.h"
#include "report/picture/workspace_drawing.h"

namespace understudy::report {
namespace {

using kinematics::Workspace;

constexpr int kWidth = 1600, kHeight = 1186;
constexpr int kViewTop = 96, kViewWidth = 900, kViewHeight = 660;
constexpr int kSlicesTop = 786, kSlice = 300, kSlicePitch = 394, kSliceLeft = 76;
constexpr int kLabelWidth = 170;

cv::Scalar bgr(const Rgb& colour) { return {double(colour[2]), double(colour[1]), double(colour[0])}; }

Rgb colour_of(const Workspace& w, int x, int y, int z) {
  const std::size_t i = w.index(x, y, z);
  if (w.binding[i] == 0) return margin_colour(w.margin[i]);
  return limit_colour(w.limits[w.binding[i] - 1].family);
}

/// A plane of the grid: across `normal`, at point `level`; u to the right, v up.
struct Slice {
  int normal, u, v, level;
};

cv::Mat colours(const Workspace& w, const Slice& slice) {
  const auto n = w.grid.cells();
  const auto columns = n[slice.u], rows = n[slice.v];
  cv::Mat pixels(rows, columns, CV_8UC3);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      std::array<int, 3> at{};
      at[slice.normal] = slice.level;
      at[slice.u] = column;
      at[slice.v] = rows - 1 - row;
      const Rgb c = colour_of(w, at[0], at[1], at[2]);
      pixels.at<cv::Vec3b>(row, column) = {c[2], c[1], c[0]};
    }
  }
  return pixels;
}

void draw_slice(cv::Mat& canvas, const Workspace& w, const Slice& slice, int left) {
  const cv::Mat cells = colours(w, slice);
  const double scale = static_cast<double>(kSlice) / std::max(cells.cols, cells.rows);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * cells.cols))),
                      std::max(1, static_cast<int>(std::lround(scale * cells.rows))));
  const int top = kSlicesTop + 50, bottom = top + size.height;
  cv::Mat enlarged;
  cv::resize(cells, enlarged, size, 0, 0, cv::INTER_NEAREST);
  enlarged.copyTo(canvas(cv::Rect({left, top}, size)));
  cv::rectangle(canvas, cv::Rect({left - 1, top - 1}, cv::Size(size.width + 2, size.height + 2)), kInk, 1);

  const auto n = w.grid.cells();
  const Vec3 first = w.grid.point(0, 0, 0), last = w.grid.point(n[0] - 1, n[1] - 1, n[2] - 1);
  std::array<int, 3> at{};
  at[slice.normal] = slice.level;
  const double level = to_mm(w.grid.point(at[0], at[1], at[2])[slice.normal]);
  write(canvas, fmt::format("{} = {:.4g} mm", "xyz"[slice.normal], level), {left, top - 16}, 0.72);
  const auto tick = [](double v) { return fmt::format("{:.4g}", std::round(1e9 * to_mm(v)) / 1e9 + 0.0); };
  const auto ends = [&](int axis) {
    return std::pair(tick(first[axis] - w.grid.step / 2), tick(last[axis] + w.grid.step / 2));
  };
  const auto [u_low, u_high] = ends(slice.u);
  const auto [v_low, v_high] = ends(slice.v);
  write(canvas, u_low, {left, bottom + 24}, 0.55);
  write(canvas, fmt::format("{} mm", "xyz"[slice.u]), {left + size.width / 2, bottom + 24}, 0.55, kInk,
        Align::centre);
  write(canvas, u_high, {left + size.width, bottom + 24}, 0.55, kInk, Align::right);
  write(canvas, v_high, {left - 8, top + 14}, 0.55, kInk, Align::right);
  write(canvas, fmt::format("{} mm", "xyz"[slice.v]), {left - 8, (top + bottom) / 2 + 6}, 0.55, kInk,
        Align::right);
  write(canvas, v_low, {left - 8, bottom}, 0.55, kInk, Align::right);
}

void draw_slices(cv::Mat& canvas, const Workspace& w) {
  const auto n = w.grid.cells();
  std::vector<Slice> slices;
  for (const int level : std::set<int>{n[2] / 6, n[2] / 2, (5 * n[2]) / 6})
    slices.push_back({2, 0, 1, level});
  slices.push_back({1, 0, 2, n[1] / 2});
  for (std::size_t i = 0; i < slices.size(); ++i)
    draw_slice(canvas, w, slices[i], kSliceLeft + static_cast<int>(i) * kSlicePitch);
}

void draw_margin_scale(cv::Mat& canvas, cv::Point at) {
  constexpr int kBar = 300, kBarHeight = 26;
  for (int x = 0; x < kBar; ++x)
    cv::line(canvas, {at.x + x, at.y}, {at.x + x, at.y + kBarHeight}, bgr(margin_colour((x + 0.5) / kBar)));
  write(canvas, "reachable: distance of the nearest axis end", {at.x, at.y - 12}, 0.62);
  write(canvas, "0", {at.x, at.y + kBarHeight + 22}, 0.55);
  write(canvas, "mid-range", {at.x + kBar, at.y + kBarHeight + 22}, 0.55, kInk, Align::right);
}

void draw_limits(cv::Mat& canvas, const Workspace& w, cv::Point at) {
  write(canvas, "not reachable: the limit that binds first", at, 0.62);
  write(canvas, "binds first, % of failing", {at.x + 640, at.y + 28}, 0.5, kFaint, Align::right);
  const double failing = static_cast<double>(w.binding.size()) - static_cast<double>(w.reachable);
  const std::size_t shown = std::min<std::size_t>(w.families.size(), kLimitColours);
  std::int64_t rest = 0;
  for (std::size_t i = kLimitColours - 1; i < w.families.size(); ++i) rest += w.families[i].binds;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool gathers = i + 1 == kLimitColours && w.families.size() > kLimitColours;
    const int y = at.y + 48 + static_cast<int>(i) * 38;
    cv::rectangle(canvas, cv::Rect(at.x, y, 30, 24), bgr(limit_colour(static_cast<int>(i))), cv::FILLED);
    write(canvas, gathers ? "other limits" : studies::limit_text(w.families[i]), {at.x + 44, y + 19}, 0.62);
    const auto binds = static_cast<double>(gathers ? rest : w.families[i].binds);
    write(canvas, fmt::format("{:.1f}", 100 * binds / failing), {at.x + 640, y + 19}, 0.62, kInk,
          Align::right);
  }
  if (w.families.empty())
    write(canvas, "every point of the grid is reachable", {at.x, at.y + 60}, 0.62, kFaint);
}

void draw_view(cv::Mat& canvas, const studies::WorkspaceStudy& study) {
  const WorkspaceView view = view_workspace(study, kViewWidth, kViewHeight);
  cv::Mat rgb(kViewHeight, kViewWidth, CV_8UC3, const_cast<std::uint8_t*>(view.picture.rgb.data()));
  cv::Mat part = canvas(cv::Rect(0, kViewTop, kViewWidth, kViewHeight));
  cv::cvtColor(rgb, part, cv::COLOR_RGB2BGR);
  const auto& grid = study.workspace.grid;
  for (int i = 0; i < 3; ++i) {
    const Vec2 at = view.axis_label_px[i];
    const auto range =
        fmt::format("{} {:.4g}..{:.4g} mm", "xyz"[i], to_mm(grid.lower[i]), to_mm(grid.upper[i]));
    const int left = i == 1 ? static_cast<int>(at.x()) : static_cast<int>(at.x()) - kLabelWidth;
    write(part, range, {std::clamp(left, 8, kViewWidth - kLabelWidth), static_cast<int>(at.y())}, 0.55);
  }
}

std::string headline(const studies::WorkspaceStudy& study) {
  const Workspace& w = study.workspace;
  std::string text = fmt::format("{:.1f} % of {} points reachable, one every {:.4g} mm", 100 * w.fraction(),
                                 w.binding.size(), to_mm(w.grid.step));
  if (const auto cube = largest_cube(w))
    text += fmt::format("; largest cube {:.4g} mm", (cube->last[0] - cube->first[0]) * to_mm(w.grid.step));
  return text;
}

}  // namespace

Rgb limit_colour(int family) {
  static constexpr std::array<Rgb, kLimitColours> kPalette{{{230, 159, 0},
                                                            {86, 180, 233},
                                                            {213, 94, 0},
                                                            {0, 114, 178},
                                                            {204, 121, 167},
                                                            {240, 228, 66},
                                                            {140, 86, 75},
                                                            {170, 170, 170}}};
  return kPalette[std::clamp(family, 0, kLimitColours - 1)];
}

Rgb margin_colour(double margin) {
  constexpr std::array<double, 3> kPale{218, 240, 214}, kDeep{0, 90, 50};
  const double t = std::clamp(margin, 0.0, 1.0);
  Rgb colour;
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(std::lround(kPale[i] + t * (kDeep[i] - kPale[i])));
  return colour;
}

renderer::Picture workspace_picture(const studies::WorkspaceStudy& study) {
  const Workspace& w = study.workspace;
  cv::Mat canvas(kHeight, kWidth, CV_8UC3, kPaper);
  draw_view(canvas, study);
  write(canvas, fmt::format("{} workspace, {}", study.machine.name, orientation_text(study)), {36, 46}, 1.0);
  write(canvas, headline(study), {36, 82}, 0.72, kFaint);
  draw_limits(canvas, w, {920, 150});
  draw_margin_scale(canvas, {920, 610});
  write(canvas, "In space, the surface has the colour of the limit that ends it there.", {920, 700}, 0.55,
        kFaint);
  write(canvas, "Slices", {36, kSlicesTop - 4}, 0.8);
  draw_slices(canvas, w);
  cv::cvtColor(canvas, canvas, cv::COLOR_BGR2RGB);
  return {kWidth, kHeight, {canvas.datastart, canvas.dataend}};
}

}  // namespace understudy::report
