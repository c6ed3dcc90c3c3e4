// In which order, direction and tool orientation the struts of a lattice can be printed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "toolpath/lattice/lattice.h"
#include "toolpath/lattice/tool_envelope.h"

namespace understudy::toolpath {

struct StrutPrint {
  int strut = 0;         ///< of the lattice
  int from = 0, to = 0;  ///< nodes; the first is there already
  Vec3 axis;             ///< unit, the tool's, all along approach, strut and retreat
  double out_from = 0;   ///< [m], along the axis from the first tip: where the tool is clear of what is built
  double out_to = 0;     ///< [m], the same at the other end, with this strut built too
};

struct SequenceLimits {
  std::vector<geometry::Shape> tool;  ///< bodies in T
  double strut_diameter = 0;          ///< [m]
  double ground_gap = 0;              ///< [m], tip above the table at a grounded node
  double margin = 0;                  ///< [m], least distance of tool and struts
  double joint = 0;     ///< [m], of each strut beside a node that it shares with the one being printed, where
                        ///< the nozzle touches it by design
  double lift = 0;      ///< [m], beyond what is built, where the tool travels
  double tilt_max = 0;  ///< [rad], from vertical
  std::function<bool(const Pose& X_WT)> reachable = {};  ///< by the machine; left out: everything
  bool accept_interference = false;  ///< where no axis is clear, take the clearest and warn
};

struct StrutSequence {
  std::vector<StrutPrint> prints;
  std::vector<std::string> warnings;
};

/// Tip at a node with the tool's axis along `axis`: the strand hangs below the nozzle, its own centre line on
/// the node; at a grounded node the tip is `ground_gap` above the table that the strut of a free strand would
/// rest on.
Vec3 tip_at(const LatticeNode& node, const Vec3& axis, double strut_diameter, double ground_gap);

/// Every strut once, each begun at a node that is grounded or at the end of an earlier strut. Found
/// backwards: of the whole frame that strut is taken off which lies highest, leaves the rest connected to the
/// ground, and could be printed last without the tool coming nearer than `margin` to the others, to the strut
/// itself, or to the table, on its path in, along the strut and out (as Huang 2021 takes frames apart). Tool
/// axes are tried from vertical outwards, 15 degrees apart. Throws InputError naming a strut that no axis is
/// clear for and the nearest strut in its path.
StrutSequence sequence_struts(const Lattice& lattice, const SequenceLimits& limits);

}  // namespace understudy::toolpath
