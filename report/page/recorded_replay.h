// A rehearsal's replay, read back from its folder of results.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/shape.h"
#include "rehearsal/record.h"
#include "rehearsal/replay.h"
#include "sim/surface/bead_sweep.h"

namespace understudy::report {

struct GapBand {
  double min = 0, max = 0;  ///< [m]
};

/// What the page draws (docs/report-data.md#replay), in SI.
struct RecordedReplay {
  std::string title;  ///< "curved-line.gcode on hexapod"
  /// Bodies, their poses at the keys, the machine's frame; the program is not read.
  rehearsal::Replay machine;
  /// Time, true pose, gap (NaN: nothing below) and extrusion only; straight between one and the next. One at
  /// least, times do not fall.
  std::vector<rehearsal::TracePoint> path;
  std::optional<double> path_within;  ///< [m], by which the true tip may be off; none: not bounded
  std::optional<geometry::Shape> table;
  std::shared_ptr<const geometry::Mesh> part;  ///< may be null
  std::vector<sim::BeadStretch> beads;
  double beads_within = 0;  ///< [m], as SweepSettings::tolerance
  std::optional<GapBand> gap_band;
  /// What the record has less than the run had, one sentence each: the print stopped, a part was left out.
  std::vector<std::string> shortfalls;
};

/// From report.html. Throws InputError naming the file: no results of a rehearsal, of another version,
/// without a replay, damaged or cut short.
RecordedReplay read_recorded_replay(const std::filesystem::path& folder);

}  // namespace understudy::report
