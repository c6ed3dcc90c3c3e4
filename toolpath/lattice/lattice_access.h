// Whether the tool can get at a strut, print it and get away, with some struts built.
#pragma once

#include <vector>

#include "toolpath/lattice/lattice_sequence.h"

namespace understudy::toolpath {

/// Tool axes to try, from vertical outwards.
std::vector<Vec3> tool_axes(double tilt_max);

class StrutAccess {
 public:
  StrutAccess(const Lattice& lattice, const SequenceLimits& limits);

  /// The first axis with which `strut` can be printed from node `from` to node `to` while `built` stand.
  /// False when there is none. Fills everything of `print`.
  bool find(int strut, int from, int to, const std::vector<int>& built, StrutPrint& print) const;

  struct Obstacle {
    double distance = 0;  ///< [m]; below 0 the tool would cut in
    int strut = -1;       ///< the nearest; -1: the table, or out of reach
  };
  /// The axis, among those that the machine and the table allow, with the largest distance, and what is
  /// nearest then.
  Obstacle clearest(int strut, int from, int to, const std::vector<int>& built, StrutPrint& print) const;

 private:
  StrutPrint print_along(int strut, int from, int to, const Vec3& axis, const std::vector<int>& built) const;
  Vec3 tip(int node, const Vec3& axis) const;
  bool allowed(const StrutPrint& print) const;
  StrutBody body(int strut, const StrutPrint& print) const;
  /// In, along and out.
  std::vector<ToolMotion> motions(const StrutPrint& print) const;
  /// The strut itself, as it stands when the tool has reached its end.
  StrutBody fresh(const StrutPrint& print) const;
  ToolMotion leaving(const StrutPrint& print) const;

  const Lattice& lattice_;
  const SequenceLimits& limits_;
  ToolEnvelope tool_;
  std::vector<Vec3> axes_;
};

}  // namespace understudy::toolpath
