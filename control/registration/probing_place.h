// A place of the part where the gap sensor can look at it, and the tool's way there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"

namespace understudy::control {

struct ProbingPlace {
  Vec3 p_W{0, 0, 0};       ///< [m], on the drawn part
  Vec3 normal_W{0, 0, 1};  ///< unit, outward: the tool's axis there
  int line = 0;            ///< of the user's file; 0: chosen by the program

  Pose X_WT(double height) const;  ///< the tip `height` [m] above it
};

/// The way to a place: `above` all of the part, down to `near`, along the tool axis to `start`.
struct ProbingWay {
  Pose above, near, start;
};

/// Where the part may be measured, of a machine and a part that outlive it.
class ProbingCheck {
 public:
  /// The part may stand `margin` [m] beside where it was drawn. Throws InputError for a margin beyond the
  /// sensor's range.
  ProbingCheck(const machine::MachineDescription& machine, const geometry::Mesh& part, double margin);
  ~ProbingCheck();

  /// Why the place cannot be measured without touching: out of reach, too near to the part or the table, not
  /// smooth, or hidden from laser or microscope. Empty: it can.
  std::string why_not(const ProbingPlace& place) const;
  ProbingWay way_to(const ProbingPlace& place) const;

  double standoff() const { return standoff_; }          ///< [m], from the place to `start`
  double clear_height() const { return clear_height_; }  ///< [m], z of W at which the tip clears the part

 private:
  std::string why_out_of_reach(const Pose& X_WT) const;
  bool sees(const Pose& X_WT, const Vec3& dot_W, const Vec3& normal_W) const;

  const machine::MachineDescription& machine_;
  const geometry::Mesh& part_;
  const double margin_, standoff_, clear_height_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  std::vector<Vec3> surface_W_;
};

}  // namespace understudy::control
