// Where to put a program: the place on the machine's table that keeps farthest from everything that would
// stop it.
//
// Each limit has a share at a pose. It is 0 at the limit, below 0 beyond, and 1 where nothing is gained by
// more:
//   an axis, or a joint of a hexapod, between two ends   2 min(q - lower, upper - q) / (upper - lower)
//   two screws of a hexapod, at least d_min apart        min(1, (d - d_min) / d_min)
//   singular posture                                     1 - ln k / ln k_max
//   bodies of the machine, table and fixture             min(1, distance / 10 mm); -depth / 10 mm
//   edge of the table, where it prints                   min(1, distance / 10 mm)
// k is the condition number of the rates, k_max what the machine's file accepts, or 1000. It does not count
// for machines that leave the tool's spin free, which drive through singular poses.
// The share of a placement is the least along the path. Its margin is the least of the limits that count:
// those that the place changes and of which some place has more than kSmallShare, and those that every place
// breaks. The others, such as the height of a first layer above the lower end of z, must only hold.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/placement/program_place.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

constexpr double kSmallShare = 0.05;
constexpr double kEnoughClearance = 10e-3;  ///< [m]; more counts as much
constexpr double kConditionFar = 1000;      ///< where the machine's file states no more than this

/// One limit at a placement.
struct LimitShare {
  std::string name;    ///< "axis x", "struts", "singular posture", "clearance", "table edge"
  double share = 0;    ///< least along the path
  double best = 0;     ///< the largest of the placements looked at
  bool counts = true;  ///< in the margin
  int line = 0;        ///< of the program, where it is least
};

/// The margin where the middle of the print stands at points of the table, turn and spin as in the answer.
struct PlacementMap {
  double x_mm = 0, y_mm = 0;            ///< the first point
  double x_step_mm = 0, y_step_mm = 0;  ///< between columns and rows
  int columns = 0, rows = 0;
  std::vector<double> margin;           ///< row by row, x fastest
  double best_x_mm = 0, best_y_mm = 0;  ///< the middle of the print in the answer
};

struct Placement {
  bool possible = false;
  std::string reason;  ///< why there is none: which limit, by how much, on which line
  ProgramPlace place;  ///< the best one; where none is possible, the least bad
  double margin = 0;   ///< of every pose of the path
  std::string least;   ///< the limit that has it
  std::vector<LimitShare> limits;
  std::optional<double> margin_as_given;  ///< at the request's own place; nothing: not asked for
  PlacementMap map;
  int poses = 0, searched_poses = 0, placements = 0;  ///< that were looked at
};

struct PlacementOptions {
  bool may_turn = true;  ///< about the table's normal, and on machines that follow it the tool's spin
  bool may_change_posture = true;  ///< of an arm, at home and so all along
  int grid = 25;                   ///< points of the map along the longer side of the table
};

/// Program, machine, fixture and dialect of `request`; its place is where the search starts from in height
/// only. The fixture is something to keep clear of. Throws InputError as a rehearsal of it would, and for a
/// program that cannot be moved: it prints nothing, or states slides while a table turns.
Placement find_placement(const RehearsalRequest& request, const PlacementOptions& options,
                         const std::function<void(double, const std::string&)>& progress = {});

}  // namespace understudy::rehearsal
