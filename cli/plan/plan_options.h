// What the `plan` commands share: options of the bead and the nozzle, in the units of the command line.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/command.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "toolpath/program.h"

namespace understudy::cli {

struct PlanOptions {
  std::string machine = machine::kDefaultMachine, output;
  double feed_mm_per_s = 5, approach_mm_per_s = 1, clearance_mm = 8;
  double bead_width_mm = 0.48, bead_height_mm = 0;  ///< height 0: the machine's gap
  double temperature_c = 230, fan = 0;
  bool rotary_words = false, quiet = false;
};

void add_machine_option(CLI::App& command, PlanOptions& options);
void add_motion_options(CLI::App& command, PlanOptions& options);
void add_bead_options(CLI::App& command, PlanOptions& options);
void add_nozzle_options(CLI::App& command, PlanOptions& options);
void add_output_option(CLI::App& command, PlanOptions& options);

/// Throws InputError with the option's name, value and limit: above 0 and at most `limit`.
void check_option(const char* name, double value, double limit);
/// The options above, and that the program can be written.
void check_options(const PlanOptions& options);

/// `X,Y,Z` in mm. Throws InputError naming the option.
Vec3 place_from(const char* option, const std::string& text);

/// Throws InputError for a machine whose tool is a mill.
machine::MachineDescription printing_machine(const std::string& name);

/// [m]: the height asked for, or the machine's gap.
double bead_height(const PlanOptions& options, const machine::MachineDescription& machine);

/// Writes the program under the name asked for, as the machine's dialect has it, with the command that made
/// it and further `notes` at its top.
void write_program(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const PlanOptions& options, const std::vector<std::string>& notes = {});

/// One line about what was written, unless --quiet.
void print_written(const PlanOptions& options, const std::string& what);

void add_plan_surface(CLI::App& plan, Action& action);
void add_plan_planar(CLI::App& plan, Action& action);
void add_plan_waypoints(CLI::App& plan, Action& action);
void add_plan_lattice(CLI::App& plan, Action& action);
void add_plan_spiral(CLI::App& plan, Action& action);
void add_plan_support_free(CLI::App& plan, Action& action);
void add_plan_finishing(CLI::App& plan, Action& action);

}  // namespace understudy::cli
