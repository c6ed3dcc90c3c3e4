// What a lab measures of a machine at rest, row by row: whole poses, positions, orientations, distances, one
// point reached in several postures, points of a plane. Everything is SI. S is the work's frame of
// a chain, and the base B of a hexapod.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "calibration/rows/row_machine.h"

namespace understudy::calibration {

enum class RowKind {
  pose,         ///< of a target on the tool, in a measuring frame
  position,     ///< of a target
  orientation,  ///< of a target
  distance,     ///< of a target from an anchor: ball bar, draw wire
  point,        ///< a target that stood in the same place whenever the row names it: sockets, plates
  plane         ///< a target that touched the plane that the row names
};
const char* to_string(RowKind kind);
/// Numbers that a row of this kind compares with the model: 6, 3 or 1.
int equations_of(RowKind kind);

struct MeasurementRow {
  RowKind kind = RowKind::pose;
  std::vector<double> axes;  ///< readings [m] or [rad]
  std::string frame;         ///< M of pose, position, orientation; empty: S itself
  std::string target;        ///< G on the tool; empty: T itself
  std::string place;         ///< of point, distance (its anchor) and plane
  Pose X_MG = Pose::Identity();
  double distance = 0;  ///< [m]
  /// 1 sigma squared of (position, rotation vector), in M; of a distance and a plane the first number, of a
  /// point the first three. 0 where `noise_told` is false.
  Mat6 covariance = Mat6::Zero();
  bool noise_told = false;
  int table = 0;  ///< which file, from 0
  int line = 0;
};

struct Plane {
  Vec3 normal = Vec3::UnitZ();  ///< unit, in S
  double offset = 0;            ///< [m]: normal . p = offset
};

/// Between two points of rows of kind `point`.
struct KnownDistance {
  std::string a, b;
  double length = 0;  ///< [m]
  double sigma = 0;   ///< [m], above 0
};

/// 1 sigma of how far a parameter may be from its drawing before any row is looked at: a wide normal prior
/// that matters only where rows tell nothing. Machine files refuse axes 10 deg away
/// (machine/file/calibration_section.h): 3 of these.
struct DrawingPrior {
  double length = 10e-3;  ///< [m]
  double angle = 0.058;   ///< [rad]
};

struct RowProblem {
  RowMachine nominal;
  DrawingPrior prior = {};
  std::vector<MeasurementRow> rows;
  // Those that are known; all others that rows name are found.
  std::map<std::string, Pose> frames;           ///< X_MS: S seen from the measuring frame
  std::map<std::string, Pose> targets;          ///< X_TG
  std::map<std::string, Vec3> points, anchors;  ///< in S
  std::map<std::string, Plane> planes;
  std::map<std::string, double> zeros;  ///< [m], of anchors; 0 where neither here nor in `with_zero`
  std::set<std::string> with_zero;      ///< anchors whose device adds an unknown length to its readings
  std::vector<KnownDistance> distances;
};

}  // namespace understudy::calibration
