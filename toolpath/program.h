// A print program as the planner and the print loop see it: poses, feeds, filament, each with its line.
#pragma once

#include <string>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

enum class StepKind {
  travel,       ///< G0: as fast as the machine allows, no filament
  move,         ///< G1 without extrusion (or with retraction)
  print,        ///< G1 that feeds filament
  home,         ///< G28: to the machine's home pose
  dwell,        ///< G4
  temperature,  ///< M104/M109
  fan,          ///< M106/M107
  end,          ///< M30
};

struct Step {
  StepKind kind = StepKind::travel;
  Pose X_WT = Pose::Identity();  ///< tool at the end of the step; for steps that do not move, unchanged
  double feed = 0;               ///< [m/s] along the tip's path (G94)
  double duration = 0;           ///< [s]: G4, or inverse-time feed (G93) when > 0 for a move
  double filament = 0;           ///< [m] fed during the step; negative retracts
  double temperature = 0;        ///< [K]
  bool wait = false;             ///< M109
  double fan = 0;                ///< 0..1
  int line = 0;                  ///< of the file, from 1
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
