// The machine as it was really built: what the plant uses and the controller does not know.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geometry/table_surface.h"
#include "machine/description.h"
#include "sim/as_built/truth_seeds.h"

namespace understudy::sim {

/// How a drive's axis moves where its motor turns: by (1 + scale) travel + periodic sin(2 pi travel / lead +
/// phase), less what that is at travel 0.
struct DriveError {
  double scale = 0;
  double periodic = 0;  ///< [m] or [rad]
  double phase = 0;     ///< [rad]
};

/// The part as it is clamped, F, about the part as it was drawn, both in W.
struct BuiltPart {
  Pose X_WF = Pose::Identity();
  double size = 1;    ///< of the drawn part, about the origin of F
  double ripple = 0;  ///< [m], amplitude of waves of the surface along its normal
  double phase = 0;   ///< [rad], of the waves
};

struct AsBuilt {
  /// "nominal", "sampled", "manufactured", "calibrated", the file it was read from, or empty: as described.
  std::string source;
  std::string machine;     ///< name of what it is built after
  std::uint64_t seed = 0;  ///< of the geometry
  // Hexapod.
  kinematics::HexapodGeometry hexapod;       ///< true 42 parameters and dev
  kinematics::PerStrut<double> nut_play{};   ///< [m], total free travel
  kinematics::PerStrut<double> ball_play{};  ///< [m]
  // Open chain.
  kinematics::Chain chain;             ///< true screws and mounts; empty for a hexapod
  kinematics::AxisVector axis_play{};  ///< [m] or [rad], total free travel
  kinematics::AxisVector axis_zero{};  ///< [m] or [rad], true position where a drive reads 0
  // Every machine.
  kinematics::PerAxis<DriveError> drives{};
  machine::Laser laser;            ///< where has_microscope
  machine::Microscope microscope;  ///< likewise
  double filament_diameter = 0;    ///< [m]
  double extruder_lag = 0;         ///< [s]
  double nozzle_offset = 0;        ///< [K], the nozzle beyond what its sensor reads
  BuiltPart part;
  geometry::TableSurface table;
};

/// A machine that is exactly what its description says, calibrated geometry included: no truth about a
/// machine that stands somewhere, but what pictures and exports show.
AsBuilt as_described(const machine::MachineDescription& machine);

/// The machine that stands there, whatever its controller believes of it. `set` is nominal (the drawing),
/// sampled (the drawing, off by the tolerances that a calibration is expected to leave), manufactured (off by
/// those of manufacture, and in drives, play, sensors, part and process by the file's other tolerances) or an
/// as-built file (as_built_file.h), which alters the drawing: calibrating a machine file changes none of
/// these. Or it is calibrated (calibrated_draw.h): what the calibration of this file leaves open. `fixture`,
/// as machine::find_fixture() takes it, may state tolerances of what is clamped. Throws InputError for
/// another word.
AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set,
                      const TruthSeeds& seeds, const std::string& fixture = {});

/// What a print is tried on unless something else is asked for: calibrated where the file has a calibration,
/// else sampled.
std::string default_as_built(const machine::MachineDescription& machine);

}  // namespace understudy::sim
