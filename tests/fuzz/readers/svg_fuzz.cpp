// Bytes as an SVG drawing.
#include "tests/fuzz/reader.h"
#include "toolpath/svg/svg_outlines.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("drawing.svg");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  std::vector<toolpath::SvgStroke> strokes;
  if (!fuzz::accepts(size, file, [&] { strokes = toolpath::read_svg(file, 20e-6); })) return 0;
  fuzz::require(!strokes.empty(), "a drawing without any outline");
  for (const toolpath::SvgStroke& stroke : strokes) {
    fuzz::require(stroke.points.size() >= 2, "an outline of fewer than two points");
    fuzz::require(!stroke.element.empty(), "an outline of no element");
    for (const Vec2& point : stroke.points)
      fuzz::require_finite(std::span(point.data(), 2), "point of " + stroke.element);
  }
  return 0;
}
