// SVG text, mark by mark; words are escaped here and nowhere else.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace understudy::report {

/// [px] of the viewBox, y down.
struct SvgPoint {
  double x = 0, y = 0;
};

class SvgDrawing {
 public:
  /// `style` is added to the element's own: empty, or as "width:300px".
  SvgDrawing(double width, double height, const std::string& style = "");

  /// What it shows, for readers who do not see it; ahead of all marks.
  void title(std::string_view words);
  /// `attributes` as in SVG: `stroke="#d9dee2" stroke-dasharray="4 4"`.
  void line(SvgPoint from, SvgPoint to, const std::string& attributes);
  void polyline(std::span<const SvgPoint> points, const std::string& attributes);
  void polygon(std::span<const SvgPoint> points, const std::string& attributes);
  /// `title` shows where the pointer rests; none where it is empty.
  void circle(SvgPoint centre, double radius, const std::string& attributes, std::string_view title = "");
  void rect(SvgPoint corner, SvgPoint size, const std::string& attributes, std::string_view title = "");
  /// `anchor` is the part of the words that stands at the point: start, middle or end.
  void text(SvgPoint at, std::string_view words, const char* anchor, const std::string& attributes = "");

  std::string finish() const;

 private:
  std::string svg_;
};

}  // namespace understudy::report
