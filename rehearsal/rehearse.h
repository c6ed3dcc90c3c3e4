// One rehearsal: program + simulated port + observers -> record with a verdict.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "rehearsal/record.h"
#include "rehearsal/scenario_faults.h"

namespace understudy::rehearsal {

struct RehearsalRequest {
  std::string program;              ///< path of a G-code file
  std::string machine = "hexapod";  ///< name or path
  std::string engine = "mujoco";
  std::string fixture;               ///< STL path, a name under models/parts, or empty: only the table
  std::string as_built = "sampled";  ///< nominal, sampled, manufactured
  std::uint64_t seed = 1;
  std::string gap_control;           ///< off, start; empty: start on a machine that sees, off on any other
  std::vector<FaultRequest> faults;  ///< what goes wrong on the way
  std::string command;               ///< for the record: how a user repeats this
  bool pictures = true;              ///< draw the scene; sweeps leave it out
  bool compare_without_gap_control =
      true;  ///< run the print again with gap control off, for open-loop figures
};

/// Share done of the whole rehearsal, 0..1, and what is being done.
using Progress = std::function<void(double share, const std::string& what)>;

/// Throws InputError for bad input, MachineError when the engine fails, Interrupted. A no-go is a result, not
/// an exception. A program that fails the constraint check is a no-go without simulation (Song 2015, 3.5).
Record rehearse(const RehearsalRequest& request, const Progress& progress = {});

/// Path of a fixture: a file, or NAME for models/parts/NAME.stl. Throws InputError naming the known ones.
std::string find_fixture(const std::string& fixture);

}  // namespace understudy::rehearsal
