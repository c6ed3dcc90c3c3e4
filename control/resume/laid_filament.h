// What a port record says a print has laid when it was cut short (docs/drive.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "machine/port.h"
#include "toolpath/program.h"

namespace understudy::control {

/// The step feeds filament along a path; one that feeds at rest primes.
bool lays_bead(const toolpath::Program& program, std::size_t index);

/// Where the nozzle last fed filament into a bead.
struct LaidFilament {
  bool ended = false;          ///< the nozzle has left that bead as programmed: all of it is laid
  bool any = false;            ///< some bead was begun
  int line = 0;                ///< of the program
  double fed = 0;              ///< [m], since the record began
  double fed_at_rest = 0;      ///< [m], at the end of the record: less where filament was drawn back since
  double fed_at_setpoint = 0;  ///< [m], at the last setpoint executed before
  machine::AxisVector axes{};  ///< [m or rad], there
  double queued = 0;           ///< [s] of motion that the machine had and that nothing says was dropped
};

struct CutRecord {
  int axes = 0;
  std::vector<std::string> notes;
  LaidFilament laid;

  /// What follows `key ` in the first note that begins so; empty: there is none.
  std::string note(const std::string& key) const;
};

/// Only setpoints that the machine has executed count, by the states that it answered; between two of them
/// its measured position decides. Beads are fed on lines of `program` that lay some. Throws InputError for a
/// file that is no record.
CutRecord read_cut_record(const std::filesystem::path& path, const toolpath::Program& program);

}  // namespace understudy::control
