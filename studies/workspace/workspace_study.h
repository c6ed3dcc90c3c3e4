// A machine's workspace as a user asks for it: which points, which orientations, and the files that answer.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/workspace/workspace.h"
#include "machine/description.h"

namespace understudy::studies {

constexpr double kWorkspacePointsMax = 50e6;

/// What is left out comes from the machine.
struct WorkspaceOptions {
  std::optional<double> tilt;     ///< [rad], of the tool's axis from upright, in [0, pi]; else as at home
  std::optional<double> azimuth;  ///< [rad], that it leans to, from x towards y of W; else as at home
  bool all_azimuths = false;      ///< a point must be reachable with all twelve, 30 degrees apart
  std::optional<std::array<double, 6>> box;  ///< [m], x0 x1 y0 y1 z0 z1 in W
  std::optional<double> step;                ///< [m]
  int threads = 1;
  std::string command;  ///< for the record
};

struct WorkspaceStudy {
  machine::MachineDescription machine;
  double tilt = 0;               ///< [rad]
  std::vector<double> azimuths;  ///< [rad]
  kinematics::WorkspaceRequest request;
  kinematics::Workspace workspace;  ///< filled by evaluate()
  std::string command;
};

/// The 100 mm cube about a hexapod's home tip; else the table's area, as high as the axis that lifts tool or
/// work reaches, or as the table's shorter side where there is none. In W.
std::array<double, 6> default_workspace_box(const machine::MachineDescription& machine);

/// Throws InputError naming option, value and limit for what cannot be asked.
WorkspaceStudy plan_workspace(const machine::MachineDescription& machine, const WorkspaceOptions& options);
/// The long part. `progress` takes the share done; throws Interrupted when the user stops it.
void evaluate(WorkspaceStudy& study, std::function<void(double)> progress = {});

/// "ball joint above 120 deg"
std::string limit_text(const kinematics::WorkspaceLimit& limit);
/// "tool upright", "tool tilted 20 deg towards azimuth 90 deg"
std::string orientation_text(const WorkspaceStudy& study);

}  // namespace understudy::studies
