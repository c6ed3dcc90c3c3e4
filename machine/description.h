// The machine description: one typed, checked source of every number (models/<machine>/machine.yaml).
// Everything here is SI; the file uses mm, degrees, mm/s and says so in its keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "geometry/shape.h"
#include "kinematics/hexapod.h"

namespace understudy::machine {

/// A linear drive: stepper, screw and nut.
struct Drive {
  double lead = 0;              ///< [m/turn]
  int steps_per_turn = 0;       ///< full steps
  int microsteps = 0;           ///< per full step
  double velocity_max = 0;      ///< [m/s]
  double acceleration_max = 0;  ///< [m/s^2]
  double step() const { return lead / (static_cast<double>(steps_per_turn) * microsteps); }  ///< [m]
};

/// Total free travel between the two ends of each play [m]; the nominal values.
struct Play {
  double screw_nut = 0;
  double ball_joint = 0;
};

struct Masses {
  double platform = 0;              ///< [kg], with tool, laser and camera
  double nut = 0;                   ///< [kg], nut and rod end of one strut
  double motor = 0;                 ///< [kg], motor body on its universal joint
  Vec3 platform_centre_T{0, 0, 0};  ///< [m], centre of mass in T
  Vec3 platform_inertia{0, 0, 0};   ///< [kg m^2], principal, about that centre along T's axes
};

struct Tool {
  double nozzle_diameter = 0;           ///< [m], bore
  double flat_diameter = 0;             ///< [m], flat ring around the bore
  double filament_diameter = 0;         ///< [m]
  std::vector<geometry::Shape> bodies;  ///< nozzle cone, heater block, platform...; poses in T
};

/// Laser beam: X_TL z along the beam. Gaussian spot.
struct Laser {
  Pose X_TL = Pose::Identity();
  double waist_diameter = 0;  ///< [m], 1/e^2 diameter at the surface
  double wavelength = 0;      ///< [m]
  double peak_level = 0;  ///< grey levels of 255 that the spot's centre reaches on a matt surface facing it
};

struct Microscope {
  Camera camera;
  Pose X_TC = Pose::Identity();
  double exposure = 0;       ///< [s]
  double transfer = 0;       ///< [s], from end of exposure until the controller has the frame
  double aperture_sine = 0;  ///< sin u on the object side: sets speckle size and depth noise
  double blur_px = 0;        ///< 1 sigma of the optics
  double full_well = 0;      ///< [electrons] at 255 grey levels
  double read_noise = 0;     ///< [electrons] 1 sigma
  double ambient_level = 0;  ///< grey levels
};

/// 1 sigma of the 42 parameters of a built machine about the description.
struct ToleranceSet {
  double joint_position = 0;  ///< [m], each coordinate of b_i and a_i
  double length_offset = 0;   ///< [m], l_i0
};
struct Tolerances {
  ToleranceSet manufactured;       ///< before any calibration
  ToleranceSet after_calibration;  ///< left after the paper's calibration
};

/// The gap between tip and surface (Song 2015, 3.3).
struct GapLimits {
  double accepted_min = 0;  ///< [m]
  double accepted_max = 0;  ///< [m]; a bead laid higher does not stick
  double aim = 0;           ///< [m]
  double standoff = 0;      ///< [m], S' out along the normal from S
};

struct MachineDescription {
  std::string name;
  std::string mechanism;       ///< "hexapod"
  std::filesystem::path file;  ///< where it was read
  std::string sha256;          ///< of the file's bytes, hexadecimal

  Pose X_WB = Pose::Identity();  ///< the base in the world
  Pose X_BT_home = Pose::Identity();

  kinematics::HexapodGeometry hexapod;
  kinematics::HexapodJoints joints;
  kinematics::HexapodLimits limits;
  double strut_radius = 0;  ///< [m], body of a strut in collision checks and pictures

  Drive drive;
  Play play;
  Masses masses;
  Tool tool;
  Laser laser;
  Microscope microscope;
  Tolerances tolerances;
  GapLimits gap;
  geometry::Shape table;            ///< pose in W; its top is z = 0
  double cycle_time = 0;            ///< [s], period of the setpoints that a port takes
  double travel_velocity = 0;       ///< [m/s], tip speed of G0
  double orientation_velocity = 0;  ///< [rad/s], limit of the tool's angular speed
  double acceleration = 0;          ///< [m/s^2], of the tip along the path

  std::unique_ptr<kinematics::Mechanism> make_mechanism() const;
};

/// `name_or_path` is a folder name under the models folder or a path of a machine.yaml (or its folder).
/// Throws InputError with file, line and the key's name for unknown, missing or misspelt keys (naming the
/// nearest known one), values of the wrong type or unit and impossible values (with the limit).
MachineDescription load_machine(const std::string& name_or_path);

/// Folder with the shipped models: $UNDERSTUDY_MODELS, the source tree's, or the installed one.
std::filesystem::path models_folder();

/// Names under models_folder() that hold a machine.yaml, sorted.
std::vector<std::string> machine_names();

}  // namespace understudy::machine
