// A chart with two axes as SVG text: what stands where is told in values, the chart knows the places.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "report/chart/svg_drawing.h"

namespace understudy::report {

/// Told apart by colour-blind eyes, too (Okabe and Ito 2008).
inline constexpr std::array<const char*, 7> kSeriesColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                           "#e69f00", "#56b4e9", "#000000"};
const char* series_colour(std::size_t series);  ///< beyond the last it begins again

/// [px]: the drawing, and what is left free around the plot for names and numbers.
struct ChartFrame {
  double width = 560, height = 300;
  double left = 56, right = 12, top = 24, bottom = 40;
};

/// The range of one axis.
class Scale {
 public:
  static Scale linear(double low, double high);
  static Scale logarithmic(double low, double high);  ///< both above 0

  double low() const { return low_; }
  double high() const { return high_; }
  /// 0 at the low end, 1 at the high one; a logarithmic scale holds what is outside at its nearer end.
  double share(double value) const;
  /// Round values within: about five; of a logarithmic scale 1, 2 and 5 of each decade.
  std::vector<double> ticks() const;

 private:
  Scale(double low, double high, bool logarithmic) : low_(low), high_(high), logarithmic_(logarithmic) {}

  double low_, high_;
  bool logarithmic_;
};

/// A point in values; `aside` [px] to the right, so that series that agree do not hide each other.
struct ChartPoint {
  double x = 0, y = 0;
  double aside = 0;
};

class SvgChart {
 public:
  SvgChart(const ChartFrame& frame, const Scale& x, const Scale& y);

  void title(const std::string& words) { drawing_.title(words); }  ///< as SvgDrawing::title()
  /// Numbers, a line across at each, and the name.
  void y_axis(const std::string& name);
  void x_axis(const std::string& name);                 ///< numbers and name
  void x_tick(double value, const std::string& words);  ///< in place of a number
  void x_name(const std::string& name);
  void key(int place, const char* colour, const std::string& words);  ///< above the plot, from the left

  void line(const std::vector<ChartPoint>& points, const std::string& attributes);
  void dot(const ChartPoint& point, const char* colour, const std::string& title);
  /// Between two lines of the same x.
  void band(const std::vector<ChartPoint>& lower, const std::vector<ChartPoint>& upper, const char* colour);

  std::string finish() const { return drawing_.finish(); }

 private:
  SvgPoint place(const ChartPoint& point) const;
  std::vector<SvgPoint> places(const std::vector<ChartPoint>& points) const;
  double bottom() const { return frame_.height - frame_.bottom; }

  ChartFrame frame_;
  Scale x_, y_;
  SvgDrawing drawing_;
};

}  // namespace understudy::report
