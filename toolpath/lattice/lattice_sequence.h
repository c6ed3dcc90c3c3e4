// In which order, direction and tool orientation the struts of a lattice can be printed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "geometry/printed_clearance.h"
#include "toolpath/lattice/lattice.h"
#include "toolpath/lattice/tool_envelope.h"

namespace understudy::toolpath {

struct StrutPrint {
  int strut = 0;          ///< of the lattice
  int from = 0, to = 0;   ///< nodes; the first is there already
  Vec3 axis;              ///< unit, the tool's, all along approach, strut and retreat
  Vec3 tip_from, tip_to;  ///< [m], of the tool
  double out_from = 0;  ///< [m], along the axis from the first tip: where the tool is clear of what is built
  double out_to = 0;    ///< [m], the same at the other end, with this strut built too
  /// From above everything built, where the tool stands upright, to out_from; and from out_to back up there.
  std::vector<Pose> arrival, departure;
};

/// Whether a machine can follow straight moves from pose to pose, the tool upright at the first: empty, or
/// what is in the way ("axis j5 is at 140.6 deg, above 135.0 deg"). `fine`: all along, else at coarse steps.
using WayCheck = std::function<std::string(const std::vector<Pose>& way, bool fine)>;

struct SequenceLimits {
  std::vector<geometry::Shape> tool;  ///< bodies in T
  double strut_diameter = 0;          ///< [m]
  double nozzle_flat = 0;             ///< [m], diameter
  double ground_gap = 0;              ///< [m], tip above the table at a grounded node
  double margin = 0;                  ///< [m], least distance of tool and struts
  double joint = 0;  ///< [m], of each strut beside a node that it shares with the one being printed: there
                     ///< the nozzle may press into it
  /// [m], how deep, of which a quarter of the margin is kept: as far as a rehearsal calls it no contact.
  double joint_press = -geometry::contact_with_printed(true);
  double lift = 0;                         ///< [m], beyond what is built, where the tool travels
  double tilt_max = 0;                     ///< [rad], from vertical
  WayCheck way = {};                       ///< of the machine; left out: it gets everywhere
  bool accept_interference = false;        ///< where no axis is clear, take the clearest and warn
  std::function<bool()> out_of_time = {};  ///< asked during the search
  long steps_max = 200'000;                ///< of the search, docs/limits.md
  Progress progress = {};                  ///< of the search and all that goes with it
};

struct StrutSequence {
  std::vector<StrutPrint> prints;
  std::vector<std::string> warnings;
  long steps = 0;  ///< of the search: struts taken off, those that were put back included
};

/// Every strut once, each begun at a node that is grounded or at the end of an earlier strut. Found
/// backwards, by taking the frame apart (disassembly.h): a strut may come off last where the tool can print
/// it without coming nearer than `margin` to the others, to the strut itself, or to the table, on its way
/// from above everything built, in, along the strut, out and back up, and where the machine can follow all of
/// that (as Huang 2021 takes frames apart). Tool axes are tried from vertical outwards, 15 degrees apart.
/// Throws InputError naming a strut that cannot be printed and what is in its way; or what the search has not
/// answered within its limits.
StrutSequence sequence_struts(const Lattice& lattice, const SequenceLimits& limits);

/// Throws InputError for limits out of range, nodes that hang in the air, and nodes below the table.
void check_sequence(const Lattice& lattice, const SequenceLimits& limits);

}  // namespace understudy::toolpath
