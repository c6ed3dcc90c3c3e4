// What a port record tells of motion: the commands that the port took, and where it measured its axes.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "machine/description.h"
#include "machine/record/record_reader.h"

namespace understudy::machine {

/// Accepted by the port.
struct RecordedCommand {
  double now = 0;  ///< [s]
  std::variant<std::vector<Setpoint>, UrgentCommand> what;
};

struct RecordedMotion {
  std::string file;
  int axes = 0;
  bool whole = false;           ///< false: it was cut short; what is whole is here
  double begins = 0, ends = 0;  ///< [s], of the port's clock
  /// The first that stands; nothing behind it is here.
  Fault fault = Fault::none;
  std::vector<RecordedCommand> commands;  ///< as their times increase
  std::vector<LoadReading> drives, load;  ///< likewise; `load` is empty where the port has no such encoders
  std::vector<std::string> notes;

  std::string note(const std::string& key) const;  ///< empty: there is none
};

/// Throws InputError for a file that is no record, and for one without a state.
RecordedMotion read_motion(const std::filesystem::path& path);

/// Throws InputError where the record has another number of axes, or names another machine file.
void require_same_machine(const RecordedMotion& motion, const MachineDescription& machine);

}  // namespace understudy::machine
