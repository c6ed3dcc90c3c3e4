// Reads a port record (docs/port-record.md) to its last whole entry.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "machine/load_reading.h"
#include "machine/port.h"

namespace understudy::machine {

struct RecordedNote {
  std::string text;
};
struct RecordedSubmit {
  double now = 0, deadline = 0;  ///< [s]
  Status answer{};
  std::vector<Setpoint> setpoints;
};
struct RecordedWait {
  double now = 0, until = 0, ended = 0;  ///< [s]
  Status answer{};
};
struct RecordedUrgent {
  double now = 0;  ///< [s]
  UrgentCommand command{};
  Status answer{};
};
struct RecordedOutputs {
  double now = 0, deadline = 0;  ///< [s]
  Outputs outputs;
  Status answer{};
};
struct RecordedFrame {
  double now = 0, deadline = 0;  ///< [s]
  Region asked;
  Status answer{};
  Frame frame;  ///< of an answer ok
};
using RecordedEntry = std::variant<RecordedNote, RecordedSubmit, AxisState, RecordedWait, RecordedUrgent,
                                   RecordedOutputs, RecordedFrame, LoadReading>;

struct RecordEnd {
  int axes = 0;
  bool whole = false;       ///< nothing follows the last whole entry
  std::uintmax_t size = 0;  ///< [bytes], up to the end of the last whole entry
};

/// Hands over every entry in order, and none that is not whole: what follows the first of these is not read.
/// Throws InputError for a file that cannot be read or is no such record.
RecordEnd read_record(const std::filesystem::path& path,
                      const std::function<void(const RecordedEntry&)>& entry);

}  // namespace understudy::machine
