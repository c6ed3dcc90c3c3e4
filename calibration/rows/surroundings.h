// What is found besides the machine: where measuring frames, targets, points, anchors and planes are.
#pragma once

#include <string>
#include <vector>

#include "calibration/rows/measurement_row.h"

namespace understudy::calibration {

struct Surroundings {
  std::vector<Pose> frames;   ///< X_MS: S seen from the measuring frame
  std::vector<Pose> targets;  ///< X_TG
  std::vector<Vec3> points;   ///< in S
  std::vector<Vec3> anchors;  ///< in S
  std::vector<double> zeros;  ///< [m], one an anchor: reading less distance
  std::vector<Plane> planes;
};

/// Which of these there are, which of their numbers are unknown, and which columns those have.
class SurroundingsLayout {
 public:
  /// A frame, target, point, anchor or plane. A column of -1: known, or told by no row.
  struct Slot {
    std::string name;
    Eigen::Index position = -1;  ///< first of three; of a plane its three
    Eigen::Index turn = -1;      ///< first of three; of an anchor its zero
    bool known = false;
  };
  /// Of one row: indices of what it names; -1 where its kind has none.
  struct Use {
    int frame = -1, target = -1, place = -1;
  };

  explicit SurroundingsLayout(const RowProblem& problem);

  std::vector<Slot> frames, targets, points, anchors, planes;
  std::vector<Use> rows;
  std::vector<std::pair<int, int>> distances;  ///< points of each known distance
  std::vector<std::string> names;              ///< of the columns: "frame tracker turn x"

  Eigen::Index columns() const { return static_cast<Eigen::Index>(names.size()); }
  /// Known ones where they are, all others at the identity.
  Surroundings known(const RowProblem& problem) const;
};

/// `by` has a number for each column. Frames and targets turn by rotation vectors: frames in M, targets in G.
Surroundings moved(const Surroundings& from, const SurroundingsLayout& layout, const Eigen::VectorXd& by);

/// Two unit vectors across `normal`: the directions in which a plane's columns tilt it.
std::pair<Vec3, Vec3> across(const Vec3& normal);

}  // namespace understudy::calibration
