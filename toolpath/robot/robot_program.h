// Programs of robot arms that print: the part of KRL (KUKA) and RAPID (ABB) that offline programming writes
// (docs/robot-programs.md).
//
// Frames: U is the base or work object that poses are stated in, N the program's tool at its centre point.
// Lengths mm, angles degrees, speeds m/s (KRL) or mm/s (RAPID).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/gcode/gcode.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

enum class RobotLanguage { krl, rapid };
const char* to_string(RobotLanguage language);  ///< "KRL", "RAPID"

/// By the ending of the name (.src; .mod .modx .prg .sys), else by how the text begins; nothing: no robot's.
std::optional<RobotLanguage> robot_language(const std::filesystem::path& path, std::string_view text);
/// Whether the name alone tells the language.
bool has_robot_ending(const std::filesystem::path& path);

/// How an output of the program feeds filament.
struct ExtruderSignal {
  /// Outputs, such as OUT[1], ANOUT[2] or doExtrude; a switched one beside an analogue one gates it;
  /// "always": every straight or round move prints. Empty: the outputs that the program sets, where they are
  /// one, or a switched and an analogue one.
  std::vector<std::string> outputs;
  /// [m^2], of the bead that lies along the path while the signal is above 0.
  std::optional<double> bead_area;
  /// [m^3/s] that a signal of 1 feeds, also at rest; a switched signal is 0 or 1.
  std::optional<double> flow_per_unit;
  double filament_diameter = 1.75e-3;  ///< [m]
};

/// An output that the program sets.
struct RobotOutput {
  std::string name;
  bool analogue = false;
  int set = 0;               ///< times
  double low = 0, high = 0;  ///< values
};

/// What a program uses, for people.
struct RobotFacts {
  RobotLanguage language = RobotLanguage::krl;
  std::map<std::string, int> statements;    ///< of motion, waiting and outputs, by name
  std::map<std::string, int> bases, tools;  ///< moves in each
  std::vector<RobotOutput> outputs;         ///< in the order of their first use
  std::vector<std::string> signal;          ///< the outputs that are taken to feed filament
  double slowest = 0, fastest = 0;          ///< [m/s], of straight and round moves
  int axis_moves = 0,
      first_axis_move = 0;      ///< moves by axis values, read as moves to home; line of the first
  std::string tool_points;      ///< axis of N that points out of the nozzle: "z", "-x"
  double rest_with_signal = 0;  ///< [s] of waiting with a switched signal on, which feeds nothing
};

struct RobotOptions {
  Pose X_WT_home = Pose::Identity();  ///< where the tool starts, and where moves by axis values take it
  Vec3 offset_W{0, 0, 0};             ///< [m], the origin of the first base that prints, in W; axes parallel
  ExtruderSignal extruder;
  /// Axis of N that points out of the nozzle, one of x -x y -y z -z; empty: the one that points down, on
  /// average over what is printed.
  std::string tool_points;
  std::size_t chords_max = kMostChords;       ///< of all arcs; a program with more is refused
  std::size_t variables_max = 1'000'000'000;  ///< [bytes], of what variables of KRL hold (docs/limits.md)
  /// Statements to pass over, upper case: "WAIT_FOR", "IF" (to its end), "$FLAG".
  std::vector<std::string> ignored;
  /// Where unknown statements are counted, which are then passed over; null: they are errors. With it, an
  /// extruder's signal and a tool's direction that the program leaves open are guessed. Not owned.
  std::vector<UnknownWordCount>* unknown = nullptr;
  RobotFacts* facts = nullptr;  ///< filled where not null. Not owned.
};

/// `text` is that of the file at `path`. The .dat file beside a .src file is read with it. Throws InputError
/// with file and line for statements that are unknown (all of the file's in one), numbers that are none,
/// motion whose speed or place the program does not say, a signal that is not told, a file without any move.
Program read_robot_program(const std::filesystem::path& path, const std::string& text,
                           const RobotOptions& options);
/// `data` is the text of the .dat file, empty: none.
Program parse_krl(const std::string& text, const std::string& data, const std::string& file,
                  const RobotOptions& options);
Program parse_rapid(const std::string& text, const std::string& file, const RobotOptions& options);

}  // namespace understudy::toolpath
