// The outlines of an SVG drawing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// A line without a break.
struct SvgStroke {
  std::vector<Vec2> points;  ///< [m], y upwards; a closed one ends where it begins
  std::string element;       ///< `<path id="u">`, and its line in the file
};

/// Outlines of path, rect, circle, ellipse, line, polyline and polygon, in the order of the file, groups and
/// transforms applied; curves become chords no farther than `chord_tolerance` [m] from them. Sizes are those
/// of the page: `width` and `height` with their units over `viewBox`, else 96 px an inch. Strokes, fills and
/// colours do not matter; what is not displayed is left out. Throws InputError with file, line, element and
/// value for text that is no SVG, elements that have no outline (text, image, use), numbers that are none,
/// path data that breaks off, transforms without an inverse, and a drawing without any outline.
std::vector<SvgStroke> read_svg(const std::filesystem::path& path, double chord_tolerance);

}  // namespace understudy::toolpath
