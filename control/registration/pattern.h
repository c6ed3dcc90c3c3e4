// Where to look at a clamped part: places chosen for what they tell, or those of a user's file.
#pragma once

#include <filesystem>
#include <vector>

#include "control/registration/part_fit.h"
#include "control/registration/probing_place.h"
#include "toolpath/program.h"

namespace understudy::control {

constexpr int kPlacesMin = 6;
constexpr int kPlacesDefault = 9;
constexpr int kPlacesMax = 100;
/// [m]: a place of a file that is farther from the drawn part is not on it.
constexpr double kOffPart = 0.1e-3;

/// [m], that the part may stand beside where it was drawn anywhere on it, four standard deviations.
double largest_shift(const geometry::Mesh& part, const PartTolerance& tolerance);

/// Where the program prints, and how far its tool leans there. Places near by tell most about the print: the
/// machine's own errors, play above all, are there what they are while it prints.
struct PrintedRegion {
  std::vector<Vec3> path_W;  ///< [m], tips of the print; empty: the whole part, at any lean
  double lean_max = 0;       ///< [rad], of the tool's axis from upright
};
PrintedRegion printed_region(const toolpath::Program& program);

/// Up to `count` places, the most telling first: each next one adds most to what is known of the pose
/// (D-optimal, greedily, from the tolerance on), among places that `check` allows and that are at least 3 mm
/// apart; within 12 mm of what is printed, or as near as there are enough. Throws InputError when fewer than
/// kPlacesMin are found.
std::vector<ProbingPlace> choose_places(const geometry::Mesh& part, const PartTolerance& tolerance,
                                        const ProbingCheck& check, const PrintedRegion& region, int count);

/// Reads a CSV `x_mm,y_mm,z_mm` of points on the drawn part, in W. Throws InputError with file and line: a
/// point farther than kOffPart from the part, one that `check` does not allow, one that stands there twice,
/// fewer than kPlacesMin.
std::vector<ProbingPlace> read_pattern(const std::filesystem::path& path, const geometry::Mesh& part,
                                       const ProbingCheck& check);

}  // namespace understudy::control
