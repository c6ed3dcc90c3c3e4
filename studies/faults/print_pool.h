// The prints that faults strike: drawn, planned, written as files, and within the limits of their machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "machine/description.h"
#include "studies/faults/print_judge.h"

namespace understudy::studies {

/// A program with the machine and the built world that it is run on.
struct PoolPrint {
  std::string what, fixture;
  machine::MachineDescription machine;  ///< as shipped
  std::string program;                  ///< below the folder of results: "programs/print-012.gcode"
  std::string machine_word;  ///< what `--machine` takes; below the folder of results where `own_machine`
  bool own_machine = false;  ///< built and calibrated by a lab, and written there
  std::string as_built;      ///< "manufactured", "sampled", "nominal"
  std::optional<std::uint64_t> world;  ///< the only seed that machine file is good for
  double duration = 0;                 ///< [s], planned
  int approaches = 0;
  std::optional<IntendedPrint> intended;
};

/// Whether the machine as drawn can print any of what is drawn for it; a nozzle that always leans cannot.
bool can_print_any(const std::string& machine_word, std::uint64_t seed);

/// Number `number` of a seed on this machine: redrawn until it breaks no limit of the machine as drawn, and
/// written below `folder`. Throws InputError where nothing is, MachineError, Interrupted.
PoolPrint make_pool_print(const std::string& machine_word, std::uint64_t seed, std::size_t number,
                          const std::filesystem::path& folder);

}  // namespace understudy::studies
