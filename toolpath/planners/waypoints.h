// Curved layers as rows of waypoints: where the tip goes and what it stands upright on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolpath/program.h"

namespace understudy::toolpath {

struct Waypoint {
  Vec3 position;  ///< [m], of the tip
  Vec3 normal;    ///< unit; the tool's axis
};

/// One curved layer, in the order of printing.
using WaypointLayer = std::vector<Waypoint>;

/// Normals are taken as they come when their length is this near to 1, and made exactly unit. The layers that
/// others publish interpolate normals between the vertices of a mesh and miss 1 by up to 1.03e-3.
constexpr double kNormalTolerance = 2e-3;

/// A file of rows `x y z nx ny nz`, positions in mm, separated by blanks; empty rows and rows that begin with
/// # are passed over. Throws InputError with file, line and column for a row that does not have six finite
/// numbers, and naming value and limit for a position beyond the largest coordinate, a normal that is not of
/// unit length, and fewer than two rows.
WaypointLayer read_waypoints(const std::filesystem::path& path);
WaypointLayer parse_waypoints(const std::string& text, const std::string& file);

/// How layers are set on the table.
struct WaypointFrame {
  Vec3 up = Vec3::UnitZ();    ///< unit, in the file: which way will be up; one of the six axes
  bool flip_normals = false;  ///< the file's normals point into the part
};
/// Turned by the rotation that takes `up` to z the shortest way.
void turn(std::vector<WaypointLayer>& layers, const WaypointFrame& frame);
/// Shifted so that the middle of their bounding box's lower side comes to `place`.
void place_on(std::vector<WaypointLayer>& layers, const Vec3& place);

struct WaypointPlan {
  double bead_width = 0;                ///< [m]
  double bead_height = 0;               ///< [m]
  double feed = 0;                      ///< [m/s]
  double approach_feed = 0;             ///< [m/s]
  double clearance = 0;                 ///< [m], of travel above all waypoints printed so far
  double largest_step = 0;              ///< [m]; waypoints farther apart are not joined by a bead
  double tilt_max = 0;                  ///< [rad], from vertical
  double filament_diameter = 0;         ///< [m]
  double temperature = 0;               ///< [K]
  double fan = 0;                       ///< 0..1
  std::vector<std::string> files = {};  ///< of the layers, in order, for errors; may be empty
};

struct WaypointProgram {
  Program program;
  int strokes = 0;        ///< stretches of bead without travel
  int single_points = 0;  ///< waypoints with no neighbour within the largest step; nothing is printed there
  double printed = 0;     ///< [m]
};

/// Layers in the order given, waypoints in the order of the file. The tip goes straight from waypoint to
/// waypoint with the tool's axis on the normal, turned there from vertical by the shortest arc. Where two
/// waypoints are more than largest_step apart, or face more than 30 degrees apart, the tool leaves along its
/// axis, rises until it is `clearance` above all that is printed, crosses, and comes down along the next
/// normal. Throws InputError for values out of range, a normal beyond tilt_max, a waypoint under the table (z
/// < 0), or when no two waypoints are near enough to print.
WaypointProgram plan_waypoints(const std::vector<WaypointLayer>& layers, const WaypointPlan& plan);

}  // namespace understudy::toolpath
