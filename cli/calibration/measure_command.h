// What the commands of `understudy measure` share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "calibration/machine/measurement_table.h"
#include "cli/command.h"
#include "cli/options/output_options.h"
#include "machine/default_machine.h"
#include "vision/boards/rig_file.h"

namespace understudy::cli {

struct MeasureCall {
  std::vector<std::string> pictures;
  std::string rig, output;
  std::string commanded;                           ///< of targets and pose
  std::string machine = machine::kDefaultMachine;  ///< likewise
  std::uint64_t seed = 1;                          ///< of pose
  OutputOptions told;
};

/// The options that all have.
void add_measure_options(CLI::App& command, const std::shared_ptr<MeasureCall>& call);
/// --commanded and --machine.
void add_commanded_options(CLI::App& command, const std::shared_ptr<MeasureCall>& call);

/// Throws InputError where the output file could not be written.
void check_output(const MeasureCall& call);

/// The commanded poses; throws InputError unless they have row `pose`, counted from 1, for picture `file`.
calibration::Measurements read_commanded(const MeasureCall& call);
const calibration::MeasuredPose& row_of_pose(const calibration::Measurements& commanded, int pose,
                                             const std::string& file);

/// On standard error: a picture, or part of one, that is left out of the result.
void report_left_out(const std::string& file, const std::string& why);

/// RFC 4180: in quotes where a comma, a quote or a line's end would split it.
std::string csv_cell(const std::string& text);

/// To the output file, with `summary` on standard output; without one, the table there and the summary on
/// standard error. `rows` decide the exit status: without any, nothing is written, and the answer is no.
int write_table(const MeasureCall& call, const std::string& table, std::size_t rows,
                const std::string& summary);

void add_measure_board(CLI::App& measure, Action& action);
void add_measure_targets(CLI::App& measure, Action& action);
void add_measure_pose(CLI::App& measure, Action& action);

}  // namespace understudy::cli
