// The cross-section of a bead that is pressed on a surface.
#pragma once

namespace understudy::sim {

/// Bores: nobody asks for a line that is wider. What is fed beyond that is a blob, and a mistake of the
/// program.
constexpr double kWidestLine = 5;

/// Width of a bead of this cross-section [m^2] pressed to the height `gap`: flat with rounded edges, area =
/// (w - g) g + pi g^2 / 4; a round strand where it is too thin to touch both sides, or the gap is not above
/// 0.
double bead_width(double area, double gap);

/// [m], height of a bead of this cross-section that is `width` wide; round where that is narrower than the
/// round strand.
double bead_height(double area, double width);

}  // namespace understudy::sim
