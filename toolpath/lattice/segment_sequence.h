// Ishak 2018, sequence planning: the order of a segmented part, each strut along its segment's build
// direction.
#pragma once

#include "toolpath/lattice/lattice_sequence.h"
#include "toolpath/lattice/segment_lattice.h"

namespace understudy::toolpath {

/// The order as it is; nothing is searched. The tool's axis is the build direction, and stays it within a
/// segment: from strut to strut the tool leaves along the axis until everything built lies below it, goes
/// across (level_travel), and comes down along the axis. `arrival` of a segment's first strut and
/// `departure` of its last one lead outside of what is printed; all others are empty. Every move keeps
/// `limits.margin` from every strut that stands by then, but as StrutAccess allows at joints. Throws
/// InputError naming segment, strut and what is in the way.
StrutSequence sequence_segments(const SegmentLattice& segments, const SequenceLimits& limits);

/// From where the tool is out of what is built at the end of one strut to the same at the begin of another
/// that has its axis, across at the height of the farther one.
std::vector<Pose> level_travel(const StrutPrint& last, const StrutPrint& next);

}  // namespace understudy::toolpath
