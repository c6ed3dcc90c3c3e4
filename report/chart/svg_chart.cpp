#include "report/chart/svg_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace understudy::report {
namespace {

/// 1, 2 or 5 times a power of ten, so that about five steps fill the range.
double tick_step(double range) {
  const double raw = range / 5, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw) return m * power;
  return 10 * power;
}

std::string number(double value) { return fmt::format("{:.4g}", value); }

}  // namespace

const char* series_colour(std::size_t series) { return kSeriesColours[series % kSeriesColours.size()]; }

Scale Scale::linear(double low, double high) { return {low, high, false}; }
Scale Scale::logarithmic(double low, double high) { return {low, high, true}; }

double Scale::share(double value) const {
  if (!logarithmic_) return (value - low_) / (high_ - low_);
  return std::log(std::clamp(value, low_, high_) / low_) / std::log(high_ / low_);
}

std::vector<double> Scale::ticks() const {
  std::vector<double> ticks;
  if (logarithmic_) {
    for (double decade = std::pow(10, std::floor(std::log10(low_))); decade <= high_; decade *= 10)
      for (const double digit : {1.0, 2.0, 5.0})
        if (decade * digit >= low_ * (1 - 1e-9) && decade * digit <= high_) ticks.push_back(decade * digit);
    return ticks;
  }
  const double step = tick_step(high_ - low_);
  const auto first = static_cast<long>(std::ceil(low_ / step - 1e-9)),
             last = static_cast<long>(std::floor(high_ / step + 1e-9));
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

SvgChart::SvgChart(const ChartFrame& frame, const Scale& x, const Scale& y)
    : frame_(frame), x_(x), y_(y), drawing_(frame.width, frame.height) {}

SvgPoint SvgChart::place(const ChartPoint& point) const {
  return {frame_.left + x_.share(point.x) * (frame_.width - frame_.left - frame_.right) + point.aside,
          bottom() - y_.share(point.y) * (bottom() - frame_.top)};
}

std::vector<SvgPoint> SvgChart::places(const std::vector<ChartPoint>& points) const {
  std::vector<SvgPoint> all;
  for (const ChartPoint& p : points) all.push_back(place(p));
  return all;
}

void SvgChart::y_axis(const std::string& name) {
  for (const double value : y_.ticks()) {
    line({{x_.low(), value}, {x_.high(), value}}, "stroke=\"#d9dee2\"");
    drawing_.text({frame_.left - 6, place({x_.low(), value}).y + 4}, number(value), "end");
  }
  const double middle = (frame_.top + bottom()) / 2;
  drawing_.text({13, middle}, name, "middle", fmt::format("transform=\"rotate(-90 13 {:.1f})\"", middle));
}

void SvgChart::x_axis(const std::string& name) {
  for (const double value : x_.ticks()) x_tick(value, number(value));
  x_name(name);
}

void SvgChart::x_tick(double value, const std::string& words) {
  drawing_.text({place({value, y_.low()}).x, bottom() + 16}, words, "middle");
}

void SvgChart::x_name(const std::string& name) {
  drawing_.text({(frame_.left + frame_.width - frame_.right) / 2, frame_.height - 6}, name, "middle");
}

void SvgChart::key(int position, const char* colour, const std::string& words) {
  drawing_.text({frame_.left + 8 + 44 * position, frame_.top - 10}, words, "start",
                fmt::format("fill=\"{}\" font-weight=\"600\"", colour));
}

void SvgChart::line(const std::vector<ChartPoint>& points, const std::string& attributes) {
  drawing_.polyline(places(points), attributes);
}

void SvgChart::dot(const ChartPoint& point, const char* colour, const std::string& title) {
  drawing_.circle(place(point), 3, fmt::format("fill=\"{}\" fill-opacity=\".75\"", colour), title);
}

void SvgChart::band(const std::vector<ChartPoint>& lower, const std::vector<ChartPoint>& upper,
                    const char* colour) {
  std::vector<SvgPoint> around = places(lower);
  const std::vector<SvgPoint> above = places(upper);
  around.insert(around.end(), above.rbegin(), above.rend());
  drawing_.polygon(around, fmt::format("fill=\"{}\" fill-opacity=\".3\"", colour));
}

}  // namespace understudy::report
