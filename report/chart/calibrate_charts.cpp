#include "report/chart/calibrate_charts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

constexpr const char* kColours[3] = {"#0072b2", "#d55e00", "#009e73"};
constexpr int kWidth = 560, kHeight = 300, kLeft = 56, kRight = 12, kTop = 24, kBottom = 40;

/// 1, 2 or 5 times a power of ten, so that about five steps fill the range.
double tick_step(double range) {
  const double raw = range / 5, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw) return m * power;
  return 10 * power;
}

class Plot {
 public:
  Plot(double x0, double x1, double y0, double y1) : x0_(x0), x1_(x1), y0_(y0), y1_(y1) {
    out_ = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" font-size=\"12\" fill=\"#5a6570\">", kWidth,
                       kHeight);
  }
  double px(double x) const { return kLeft + (x - x0_) / (x1_ - x0_) * (kWidth - kLeft - kRight); }
  double py(double y) const { return kTop + (y1_ - y) / (y1_ - y0_) * (kHeight - kTop - kBottom); }

  void y_axis(const std::string& label) {
    const double step = tick_step(y1_ - y0_);
    for (double y = std::ceil(y0_ / step) * step; y <= y1_ + 1e-9 * step; y += step) {
      line(x0_, y, x1_, y, "#d9dee2");
      text(kLeft - 6, py(y) + 4, fmt::format("{:.4g}", std::abs(y) < 1e-9 * step ? 0.0 : y), "end");
    }
    out_ += fmt::format("<text transform=\"translate(13 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                        (kTop + kHeight - kBottom) / 2, label);
  }
  void x_ticks(const std::string& label) {
    const double step = std::max(tick_step(x1_ - x0_), 1e-9);
    for (double x = std::ceil(x0_ / step) * step; x <= x1_ + 1e-9 * step; x += step)
      x_tick(x, fmt::format("{:.4g}", std::abs(x) < 1e-9 * step ? 0.0 : x));
    x_label(label);
  }
  void x_tick(double x, const std::string& name) { text(px(x), kHeight - kBottom + 16, name, "middle"); }
  void x_label(const std::string& label) {
    text((kLeft + kWidth - kRight) / 2.0, kHeight - 6, label, "middle");
  }
  void line(double xa, double ya, double xb, double yb, const char* colour, const char* more = "") {
    out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" {}/>",
                        px(xa), py(ya), px(xb), py(yb), colour, more);
  }
  void dot(double x, double y, const char* colour, const std::string& title) {
    out_ += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\" fill-opacity=\".75\"><title>{}"
        "</title></circle>",
        px(x), py(y), colour, title);
  }
  void key(int place, const char* colour, const std::string& name) {
    out_ += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\" font-weight=\"600\">{}</text>",
                        kLeft + 8 + 44 * place, kTop - 10, colour, name);
  }
  std::string finish() { return out_ + "</svg>"; }

 private:
  void text(double x, double y, const std::string& words, const char* anchor) {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, words);
  }

  double x0_, x1_, y0_, y1_;
  std::string out_;
};

/// Symmetric about 0, with room.
double span_of(const std::vector<double>& values, double least) {
  double largest = least;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return 1.08 * largest;
}

/// Pale to deep, through blue.
std::string heat(double share) {
  constexpr std::array<double, 3> kLow{232, 241, 248}, kHigh{8, 48, 107};
  const double t = std::clamp(share, 0.0, 1.0);
  std::array<int, 3> c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<int>(std::lround(kLow[i] + t * (kHigh[i] - kLow[i])));
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}  // namespace

double normal_quantile(double p) {
  constexpr double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                          1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr double b[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                          6.680131188771972e+01, -1.328068155288572e+01};
  constexpr double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                          -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                          3.754408661907416e+00};
  constexpr double kTail = 0.02425;
  if (p < kTail) {
    const double q = std::sqrt(-2 * std::log(p));
    return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
           ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1);
  }
  if (p > 1 - kTail) return -normal_quantile(1 - p);
  const double q = p - 0.5, r = q * q;
  return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
         (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1);
}

std::vector<double> ordered_residuals(const CalibrateResult& result) {
  std::vector<double> values;
  for (const PoseResidual& p : result.poses)
    for (Eigen::Index i = 0; p.used && i < 6; ++i) values.push_back(p.whitened[i]);
  // A fit takes up the share of its parameters: without that, residuals would look too small.
  const double left = std::max(1, result.degrees_of_freedom);
  for (double& v : values) v *= std::sqrt(static_cast<double>(values.size()) / left);
  std::sort(values.begin(), values.end());
  return values;
}

std::string pose_chart(const CalibrateResult& result) {
  std::vector<double> all;
  for (const PoseResidual& p : result.poses)
    for (Eigen::Index i = 0; p.used && i < 3; ++i) all.push_back(to_um(p.after[i]));
  const double top = span_of(all, 1);
  Plot plot(0, static_cast<double>(result.poses.size() + 1), -top, top);
  plot.y_axis("tip residual, µm");
  plot.x_ticks("pose");
  for (int i = 0; i < 3; ++i) plot.key(i, kColours[i], std::string(1, "xyz"[i]));
  for (std::size_t j = 0; j < result.poses.size(); ++j)
    for (Eigen::Index i = 0; i < 3; ++i) {
      const PoseResidual& p = result.poses[j];
      // A rejected pose may be far outside: it stands at the edge, in grey.
      const double v = std::clamp(to_um(p.after[i]), -top, top);
      plot.dot(static_cast<double>(j + 1) + 0.18 * static_cast<double>(i - 1), v,
               p.used ? kColours[i] : "#9aa3ab",
               fmt::format("line {}, {}: {:.1f} µm{}", p.line, "xyz"[i], to_um(p.after[i]),
                           p.used ? "" : ", rejected"));
    }
  return plot.finish();
}

std::string spread_chart(const CalibrateResult& result) {
  const bool struts = !result.poses.empty() && !result.poses.front().strut.empty();
  const auto value = [&](const PoseResidual& p, std::size_t i) {
    return struts ? p.strut[i] / p.strut_sigma[i] : p.whitened[static_cast<Eigen::Index>(i)];
  };
  std::vector<double> all;
  for (const PoseResidual& p : result.poses)
    for (std::size_t i = 0; p.used && i < 6; ++i) all.push_back(value(p, i));
  const double top = span_of(all, 3);
  Plot plot(0.4, 6.6, -top, top);
  plot.y_axis("residual / stated sigma");
  for (const double side : {-2.0, 2.0})
    plot.line(0.4, side, 6.6, side, "#9aa3ab", "stroke-dasharray=\"4 4\"");
  constexpr const char* kCoordinates[6] = {"x", "y", "z", "turn x", "turn y", "turn z"};
  for (int i = 0; i < 6; ++i) plot.x_tick(i + 1, struts ? fmt::format("strut {}", i + 1) : kCoordinates[i]);
  const double count = static_cast<double>(std::max<std::size_t>(1, result.poses.size()));
  for (std::size_t j = 0; j < result.poses.size(); ++j)
    for (std::size_t i = 0; result.poses[j].used && i < 6; ++i)
      plot.dot(static_cast<double>(i + 1) + 0.6 * (static_cast<double>(j) / count - 0.5),
               value(result.poses[j], i), kColours[0],
               fmt::format("line {}: {:.2f}", result.poses[j].line, value(result.poses[j], i)));
  return plot.finish();
}

std::string quantile_chart(const CalibrateResult& result) {
  const std::vector<double> values = ordered_residuals(result);
  const double top = span_of(values, 3);
  Plot plot(-3.6, 3.6, -top, top);
  plot.y_axis("residual / sigma");
  plot.x_ticks("quantile of a normal distribution");
  plot.line(-std::min(3.6, top), -std::min(3.6, top), std::min(3.6, top), std::min(3.6, top), "#d55e00");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double expected =
        normal_quantile((static_cast<double>(k) + 0.5) / static_cast<double>(values.size()));
    plot.dot(std::clamp(expected, -3.6, 3.6), values[k], kColours[0], fmt::format("{:.2f}", values[k]));
  }
  return plot.finish();
}

std::string heat_key(double top) {
  constexpr int kSteps = 40, kStep = 6;
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {} 34\" style=\"width:{}px\" role=\"img\" font-size=\"12\" fill=\"#5a6570\">",
      kSteps * kStep + 60, kSteps * kStep + 60);
  for (int i = 0; i < kSteps; ++i)
    out += fmt::format("<rect x=\"{}\" y=\"2\" width=\"{}\" height=\"12\" fill=\"{}\"/>", 2 + i * kStep,
                       kStep + 1, heat((i + 0.5) / kSteps));
  for (int i = 0; i <= 2; ++i)
    out +=
        fmt::format("<text x=\"{}\" y=\"29\" text-anchor=\"{}\">{:.3g}{}</text>", 2 + i * kSteps * kStep / 2,
                    i == 0 ? "start" : "middle", to_um(0.5 * i * top), i == 2 ? " µm" : "");
  return out + "</svg>";
}

std::string slice_chart(const TipMap::Slice& slice, double top) {
  const int cell = 380 / std::max(slice.columns, slice.rows);
  const int width = cell * slice.columns, height = cell * slice.rows;
  std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" font-size=\"12\" fill=\"#5a6570\">",
                                width + 70, height + 32);
  for (int row = 0; row < slice.rows; ++row)
    for (int column = 0; column < slice.columns; ++column) {
      const double sigma = slice.sigma[static_cast<std::size_t>(row * slice.columns + column)];
      if (!std::isfinite(sigma)) continue;
      out += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"><title>{} {:.0f}, {} {:.0f} "
          "mm: {:.1f} µm</title></rect>",
          58 + column * cell, 6 + (slice.rows - 1 - row) * cell, cell, cell, heat(sigma / top), slice.u,
          to_mm(slice.u0 + column * slice.step), slice.v, to_mm(slice.v0 + row * slice.step), to_um(sigma));
    }
  const auto text = [&](int x, int y, const std::string& words, const char* anchor) {
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>", x, y, anchor, words);
  };
  const auto mm = [](double v) { return fmt::format("{:.0f}", std::round(to_mm(v)) + 0.0); };  // no -0
  text(58, height + 22, mm(slice.u0), "start");
  text(58 + width / 2, height + 22, fmt::format("{} mm", slice.u), "middle");
  text(58 + width, height + 22, mm(slice.u0 + (slice.columns - 1) * slice.step), "end");
  text(52, height, mm(slice.v0), "end");
  text(52, 6 + height / 2, fmt::format("{} mm", slice.v), "end");
  text(52, 18, mm(slice.v0 + (slice.rows - 1) * slice.step), "end");
  return out +
         fmt::format(
             "<rect x=\"58\" y=\"6\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#9aa3ab\"/></svg>",
             width, height);
}

}  // namespace understudy::rehearsal
