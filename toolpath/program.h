// A print program as the planner and the print loop see it: poses, feeds, filament, each with its line.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

enum class StepKind : unsigned char {
  travel,       ///< G0: as fast as the machine allows, no filament
  move,         ///< G1 without extrusion (or with retraction)
  print,        ///< G1, or G0, that feeds filament
  home,         ///< G28 of all axes: to the machine's home pose
  dwell,        ///< G4
  temperature,  ///< M104/M109
  fan,          ///< M106/M107
  end,          ///< M30
};

/// Turning axes as a program of rotary words says them, unwound. [rad]
struct RotaryTurns {
  double b = 0, c = 0;
};

/// [m/s^2], where the program says none.
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct Step {
  Pose X_WT = Pose::Identity();  ///< tool at the end of the step; for steps that do not move, unchanged
  /// Where the program says how the turning axes stand at the end of the step: they run there linearly, from
  /// wherever they are, while the tip runs straight over the work; X_WT is made of them and of the tip.
  std::optional<RotaryTurns> rotary = std::nullopt;
  double feed = 0;                   ///< [m/s] along the tip's path (G94)
  double duration = 0;               ///< [s]: G4, or inverse-time feed (G93) when > 0 for a move
  double acceleration = kUnlimited;  ///< [m/s^2] along the tip's path, at most (M204)
  double filament = 0;               ///< [m] fed during the step; negative retracts
  double temperature = 0;            ///< [K]
  double fan = 0;                    ///< 0..1
  int line = 0;                      ///< of the file, from 1
  StepKind kind = StepKind::travel;
  bool wait = false;  ///< M109
};

struct Program {
  std::string file;    ///< as the user named it
  std::string sha256;  ///< of its bytes
  std::vector<Step> steps;
};

inline bool moves(const Step& s) {
  return s.kind == StepKind::travel || s.kind == StepKind::move || s.kind == StepKind::print ||
         s.kind == StepKind::home;
}

}  // namespace understudy::toolpath
