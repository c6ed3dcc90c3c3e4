// A port record fed to the twin: the very commands that a machine got, and how far its axes were from the
// twin's at each time (docs/identify.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "machine/record/recorded_motion.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

struct RecordReplayRequest {
  std::string record;     ///< path of a port record
  RehearsalRequest twin;  ///< machine, as_built, engine, seed and command; the rest is not looked at
  /// Largest difference of an axis that is still agreement; nothing: see agreed_default().
  std::optional<double> agree_length, agree_angle;  ///< [m], [rad]
};

/// On which side of the play a position was measured.
enum class MeasuredSide { drive, load };
const char* to_string(MeasuredSide side);

/// Of a slide or strut [m], of a turn [rad]: a full step and a microstep where the drives measure (a motor
/// that loses steps loses four), the play with three
/// times its tolerance, a microstep and a count behind it.
double agreed_default(const machine::MachineDescription& machine, int axis, MeasuredSide side);

/// The machine less the twin.
struct AxisDifference {
  std::string axis;
  bool angle = false;
  MeasuredSide side{};
  double mean = 0, rms = 0;  ///< [m] or [rad]
  double largest = 0;        ///< with its sign
  double time = 0;           ///< [s], of the largest, since the record began
  int line = 0;              ///< that was commanded then
  double agreed = 0;         ///< the limit that it is compared with
  bool agrees() const;
};

struct ReplayedRow {
  double time = 0;                           ///< [s], since the record began
  int line = 0;                              ///< that was commanded
  kinematics::AxisVector machine{}, twin{};  ///< [m] or [rad]
};

struct ReplayedRecord {
  std::string record, machine, as_built, engine, command;
  std::vector<std::string> axis_names;
  std::vector<bool> axis_angles;
  bool whole = false;  ///< the record was not cut short
  std::vector<ReplayedRow> drive_rows, load_rows;
  std::vector<AxisDifference> differences;  ///< of the drives, then behind the play, by axis
  std::vector<std::string> notes;           ///< on what was not compared
  std::string stopped;                      ///< why the twin did not take the commands; empty: it did
  bool agrees() const;
};

/// Throws InputError for a record that cannot be used or is of another machine, MachineError when the engine
/// fails, Interrupted.
ReplayedRecord replay_record(const RecordReplayRequest& request, const Progress& progress);

}  // namespace understudy::rehearsal
