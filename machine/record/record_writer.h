// Writes a port record, entry by entry.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/file/append_file.h"
#include "machine/load_reading.h"
#include "machine/port.h"
#include "machine/record/record_format.h"

namespace understudy::machine {

/// Entries gather in memory until flush(), so that a control cycle does no I/O.
class RecordWriter {
 public:
  /// `anew`: throws InputError where the file is there already. Else it must be a record of as many axes.
  RecordWriter(const std::filesystem::path& path, int axes,
               AppendFile::Begin begin = AppendFile::Begin::anew);
  ~RecordWriter();
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// A line for people and programs: `key words...`.
  void note(std::string_view text);
  void submit(double now, double deadline, std::span<const Setpoint> setpoints, Status answer);
  void state(const AxisState& state);
  void load(const LoadReading& reading);
  void wait(double now, double until, double ended, Status answer);
  void urgent(double now, UrgentCommand command, Status answer);
  void outputs(double now, const Outputs& outputs, double deadline, Status answer);
  void frame(double now, const Region& asked, double deadline, Status answer, const Frame& frame);
  /// Throws MachineError where that fails, as with a full disk.
  void flush();

 private:
  template <typename T>
  void put(const T& value);
  void put_axes(const AxisVector& values);
  void put_region(const Region& region);
  std::size_t begin(RecordKind kind);
  void end(std::size_t begun);

  AppendFile file_;
  std::size_t axes_;
  std::string bytes_;  ///< not written yet
};

}  // namespace understudy::machine
