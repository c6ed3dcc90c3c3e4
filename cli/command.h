// The sub-commands of `understudy`: each registers itself and sets the action to run and its exit status.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>

namespace understudy::cli {

/// Exit status of every command (the contract).
enum Exit : int { kGood = 0, kNo = 1, kBadInput = 2, kFailed = 3 };

using Action = std::function<int()>;

void add_rehearse(CLI::App& app, Action& action);
void add_inspect(CLI::App& app, Action& action);
void add_pose(CLI::App& app, Action& action);
void add_place(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_register(CLI::App& app, Action& action);
void add_scenario(CLI::App& app, Action& action);
void add_sweep(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_kinematics(CLI::App& app, Action& action);  ///< axes, poses
void add_calibrate(CLI::App& app, Action& action);
CLI::App* add_calibrate_gap_sensor(CLI::App& calibrate, Action& action);
void add_measure(CLI::App& app, Action& action);  ///< board, targets, pose
void add_sample_poses(CLI::App& app, Action& action);
void add_sample_gaps(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);
void add_workspace(CLI::App& app, Action& action);
void add_repeatability(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_export_mjcf(CLI::App& command, Action& action);
void add_export_trace(CLI::App& command, Action& action);
void add_export_glb(CLI::App& command, Action& action);
void add_export_hal(CLI::App& command, Action& action);
void add_export_linuxcnc(CLI::App& command, Action& action);
void add_benchmark(CLI::App& app, Action& action);  ///< calibration, gap, faults
void add_benchmark_calibration(CLI::App& benchmark, Action& action);
void add_benchmark_gap(CLI::App& benchmark, Action& action);
void add_benchmark_faults(CLI::App& benchmark, Action& action);
void add_drive(CLI::App& app, Action& action);
void add_post(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);
void add_inspection(CLI::App& app, Action& action);  ///< machines, doctor

/// The commands that need the twin; none where the build is without it (cmake --preset controller).
void add_twin_commands(CLI::App& app, Action& action);
/// Names of the commands that this build leaves out; empty with the twin.
std::vector<std::string> left_out_commands();

/// The word as a shell reads it, in single quotes where it needs them.
std::string shell_quoted(std::string_view word);
/// Words of the command line, quoted where a shell needs it: how a user repeats this run.
void remember_command_line(int argc, char** argv);
void remember_command_line(const std::vector<std::string>& words);  ///< without the first, `understudy`
void restore_command_line(const std::string& line);                 ///< as command_line() gave it
const std::string& command_line();
/// The words again.
std::vector<std::string> split_command_line(const std::string& line);

/// After app.parse(): throws CLI::ConversionError for a number of the words that is an empty word, as of a
/// variable of a script that is not set, which CLI11 takes for 0; and for one that is not finite, which is
/// within any CLI::Range.
void check_numbers(const CLI::App& app);

}  // namespace understudy::cli
