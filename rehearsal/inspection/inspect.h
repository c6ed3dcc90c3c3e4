// A look at a program before it is rehearsed.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/inspection/print_time.h"
#include "rehearsal/program/readings.h"
#include "rehearsal/request/request.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/inspection/program_summary.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::rehearsal {

struct Inspection {
  int lines = 0;
  std::vector<toolpath::UnknownWordCount> unknown;  ///< their lines are passed over here
  std::vector<toolpath::PassedOver> passed_over;    ///< lines that cannot be read
  toolpath::RefusedLines refused;                   ///< lines that a rehearsal refuses, left out here
  /// E that looks relative where no M83 says so; it is read so here, and in `request`.
  std::optional<toolpath::ExtrusionTally> relative_extrusion;
  std::optional<double> told_filament;              ///< [m], of the slicer's comment
  std::string told_material;                        ///< of the slicer's comment; empty: none
  std::map<std::string, std::string> slicer_facts;  ///< from comments
  std::map<std::string, double> feature_lengths;    ///< [m] printed, by the types that comments name
  toolpath::ProgramSummary summary;                 ///< under the first of `readings`, if there are any
  std::vector<RotaryReading> readings;              ///< the most likely first; none without rotary words
  std::string rotary_letters;                       ///< that `readings` are about
  /// Rotary words of the program that the machine does not have, such as "AC", and the machines of models/
  /// that have them. The first of those then takes the machine's place here and in `request`; without any,
  /// the words are read as if they turned nothing.
  std::string foreign_words;
  std::vector<std::string> machines_with_words;
  std::optional<toolpath::RobotFacts> robot;  ///< of KRL and RAPID
  std::string told_by;           ///< how its language is known: "its ending", "its content"; empty: G-code
  std::optional<double> nozzle;  ///< [m], that the slicer worked for
  double machine_nozzle = 0;     ///< [m]
  std::string machine_material;  ///< that the machine's file names; empty: it prints none
  PrintTime time;                ///< of what `request` asks for
  /// How it may be rehearsed: dialect, place on the table, words to ignore, temperature.
  RehearsalRequest request;
};

/// Reads `program` as for `machine`, with `macros` (a path; empty: none); unknown words are counted, not
/// refused. Readings are ranked as rank_readings() does. Throws InputError as read_gcode() does.
/// Of `told`, nozzle, layer, temperature and relative E count, ahead of what comments say, and words to
/// ignore.
Inspection inspect(const std::string& program, const std::string& machine, const std::string& macros = {},
                   const DialectRequest& told = {});

/// "understudy rehearse ..." with the options that differ from their defaults.
std::string rehearse_command(const RehearsalRequest& request, const std::string& folder);

}  // namespace understudy::rehearsal
