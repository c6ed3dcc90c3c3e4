// The space that a tool takes, as solids of revolution about its axis, and how near struts come to it.
#pragma once

#include <limits>
#include <vector>

#include "core/frames.h"
#include "geometry/shape.h"

namespace understudy::toolpath {

/// A straight strut or strand with round ends.
struct StrutBody {
  Vec3 from, to;      ///< [m]
  double radius = 0;  ///< [m]
};

/// A tool that moves from `from` to `to` [m, its tip] without turning, its axis (unit) towards the machine.
struct ToolMotion {
  Vec3 from, to;
  Vec3 axis;
};

class ToolEnvelope {
 public:
  /// Bodies in T. A frustum or cylinder on the tool's axis is taken as it is, anything else as the cylinder
  /// about that axis that holds it: the answers err to the safe side only, whatever the tool's spin.
  /// Distances are those to contact: to the nozzle they count from `press` [m] below its surface.
  explicit ToolEnvelope(const std::vector<geometry::Shape>& bodies, double press = 0);

  /// The space that the tool sweeps while it leaves along its own axis, without end.
  ToolEnvelope lifted() const;

  /// [m], of a point in T to the envelope; negative inside; infinite for a tool without bodies.
  double distance(const Vec3& p_TP) const;
  /// Smallest distance of a strut's surface to the moving tool, to within 2 x `tolerance` [m] from below.
  double distance(const StrutBody& strut, const ToolMotion& motion, double tolerance) const;
  /// Whether that distance is at least `margin`; within 2 um of it the answer may be no. Much faster.
  bool clears(const StrutBody& strut, const ToolMotion& motion, double margin) const;
  /// Likewise while the tool turns about its tip from one axis to the other, the short way. Errs to the safe
  /// side by up to a degree's motion of the tool's far end.
  bool clears_turn(const StrutBody& strut, const Vec3& tip, const Vec3& from_axis, const Vec3& to_axis,
                   double margin) const;

  /// [m], height of the tool's lowest point above its tip where its axis is `axis`; not above 0.
  double lowest(const Vec3& axis) const;
  /// [m], largest distance of the envelope from the axis, less than `below` above the tip.
  double radius(double below = std::numeric_limits<double>::infinity()) const;
  /// [m], largest distance of the envelope from the tip.
  double reach() const;

 private:
  struct Section {
    double z0, z1, r0, r1;  // radii at both heights [m]
    double press;           // [m]
  };
  static bool holds(const Section& outer, const Section& inner);
  std::vector<Section> sections_;
};

}  // namespace understudy::toolpath
