// The attribute `transform` of SVG.
#pragma once

#include <string>

#include <Eigen/Geometry>

namespace understudy::toolpath {

using SvgTransform = Eigen::Transform<double, 2, Eigen::Affine>;

/// The product of a list of matrix, translate, scale, rotate, skewX and skewY, angles in degrees. Throws
/// InputError, without a place, for another function, a wrong count of numbers, and a transform without an
/// inverse, which lays the drawing on a line or a point. Source: SVG 1.1, 7.6.
SvgTransform svg_transform(const std::string& text);

}  // namespace understudy::toolpath
