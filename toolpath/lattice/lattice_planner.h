// From a lattice to a print program.
#pragma once

#include "toolpath/lattice/lattice_sequence.h"
#include "toolpath/lattice/segment_lattice.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

struct LatticePlan {
  SequenceLimits limits;
  double feed = 0;               ///< [m/s], along a strut (Ishak 2018: 1 mm/s)
  double approach_feed = 0;      ///< [m/s], over the last `approach` to where a strut begins
  double approach = 0;           ///< [m]
  double dwell = 0;              ///< [s], at the end of each strut, for it to solidify
  double filament_diameter = 0;  ///< [m]
  double temperature = 0;        ///< [K]
  double fan = 0;                ///< 0..1
};

struct LatticeProgram {
  Program program;
  StrutSequence sequence;
  double printed = 0;  ///< [m], length of all struts
};

/// Each strut: travel to where the tool is clear of what is built, in along the tool's axis, the strut in one
/// move with pi d^2 / 4 of the tip's way as volume, a dwell, out along the axis. Two struts in a row with one
/// axis, the second from the first one's end, are printed without leaving. Else the tool travels above
/// everything built, upright, on the ways that sequence_struts has checked. Throws InputError as
/// sequence_struts does and for values out of range.
LatticeProgram plan_lattice(const Lattice& lattice, const LatticePlan& plan);

/// The same for a segmented part, in the order of sequence_segments. The machine is asked for every pose of
/// the program (`plan.limits.way`).
LatticeProgram plan_segments(const SegmentLattice& segments, const LatticePlan& plan);

}  // namespace understudy::toolpath
