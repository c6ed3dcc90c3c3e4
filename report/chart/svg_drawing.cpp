#include "report/chart/svg_drawing.h"

#include <fmt/format.h>

#include "report/markup.h"

namespace understudy::report {
namespace {

std::string list_of(std::span<const SvgPoint> points) {
  std::string list;
  for (const SvgPoint& p : points) list += fmt::format("{}{:.1f},{:.1f}", list.empty() ? "" : " ", p.x, p.y);
  return list;
}

std::string title_element(std::string_view title) {
  return title.empty() ? "" : "<title>" + html_text(title) + "</title>";
}

}  // namespace

SvgDrawing::SvgDrawing(double width, double height, const std::string& style)
    : svg_(fmt::format("<svg viewBox=\"0 0 {:g} {:g}\"{} role=\"img\" font-size=\"12\" fill=\"#5a6570\">\n",
                       width, height, style.empty() ? "" : fmt::format(" style=\"{}\"", style))) {}

void SvgDrawing::title(std::string_view words) { svg_ += title_element(words) + "\n"; }

void SvgDrawing::line(SvgPoint from, SvgPoint to, const std::string& attributes) {
  svg_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x, from.y,
                      to.x, to.y, attributes);
}

void SvgDrawing::polyline(std::span<const SvgPoint> points, const std::string& attributes) {
  if (points.size() < 2) return;
  svg_ += fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", list_of(points), attributes);
}

void SvgDrawing::polygon(std::span<const SvgPoint> points, const std::string& attributes) {
  svg_ += fmt::format("<polygon points=\"{}\" {}/>\n", list_of(points), attributes);
}

void SvgDrawing::circle(SvgPoint centre, double radius, const std::string& attributes,
                        std::string_view title) {
  svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" {}>{}</circle>\n", centre.x, centre.y,
                      radius, attributes, title_element(title));
}

void SvgDrawing::rect(SvgPoint corner, SvgPoint size, const std::string& attributes, std::string_view title) {
  svg_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}>{}</rect>\n",
                      corner.x, corner.y, size.x, size.y, attributes, title_element(title));
}

void SvgDrawing::text(SvgPoint at, std::string_view words, const char* anchor,
                      const std::string& attributes) {
  svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", at.x, at.y, anchor,
                      attributes, html_text(words));
}

std::string SvgDrawing::finish() const { return svg_ + "</svg>"; }

}  // namespace understudy::report
