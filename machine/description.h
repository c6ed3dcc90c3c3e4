// The machine description: one typed, checked source of every number (models/NAME/machine.yaml).
// Everything here is SI; the file uses mm, degrees, mm/s and says so in its keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "geometry/shape.h"
#include "kinematics/chain/chain.h"
#include "kinematics/hexapod/hexapod_passive_rotation.h"
#include "machine/control_settings.h"
#include "machine/program_dialect.h"

namespace understudy::machine {

/// A drive: stepper with a screw, belt or gear behind it. "Unit" is [m], or [rad] for an axis that turns.
struct Drive {
  double lead = 0;          ///< [unit/turn] of the motor
  int steps_per_turn = 0;   ///< full steps
  int microsteps = 0;       ///< per full step
  double velocity_max = 0;  ///< [unit/s]
  /// Change of speed that the motor takes at once at a corner without losing steps [unit/s]; 0: none beyond
  /// what its acceleration allows within a cycle.
  double velocity_jump = 0;
  double acceleration_max = 0;  ///< [unit/s^2]
  /// Rotor and load against the commanded field, as seen on the axis [N/m] or [N m/rad]; 0: the motor is
  /// where it is commanded. With it, the rotor swings at `resonance` when the axis carries nothing else.
  double stiffness = 0;
  double resonance = 0;       ///< [Hz], of the bare motor; above 0 with a stiffness
  double damping_ratio = 0;   ///< of that resonance
  bool self_locking = false;  ///< keeps its place without current: a screw of small lead, a worm, a brake
  double step() const { return lead / (static_cast<double>(steps_per_turn) * microsteps); }  ///< [unit]
  /// Rotor's inertia as seen on the axis [kg] or [kg m^2]; 0 without a stiffness.
  double rotor() const;
};

/// Total free travel between the two ends of each play [m]; the nominal values.
struct Play {
  double screw_nut = 0;
  double ball_joint = 0;
  double friction = 0;  ///< [N], along the strut, below which the parts of a strut stay where they touch
};

struct Masses {
  double platform = 0;              ///< [kg], with tool, laser and camera
  double nut = 0;                   ///< [kg], nut and rod end of one strut
  double motor = 0;                 ///< [kg], motor body on its universal joint
  Vec3 platform_centre_T{0, 0, 0};  ///< [m], centre of mass in T
  Vec3 platform_inertia{0, 0, 0};   ///< [kg m^2], principal, about that centre along T's axes
};

/// Whether the joints turn the lead screws in their nuts, a lead of strut length per turn.
enum class ScrewRotation {
  guided,       ///< rails keep the screws from turning
  free,         ///< they turn, and the controller does not know
  compensated,  ///< they turn, and the controller's kinematics has it
};

/// A hanging platform on six screw struts (Song 2015).
struct HexapodModel {
  kinematics::HexapodGeometry geometry;  ///< what the controller reckons with: calibrated where it was
  kinematics::HexapodGeometry design;    ///< as drawn
  kinematics::HexapodJoints joints;
  kinematics::HexapodLimits limits;
  double strut_radius = 0;  ///< [m], body of a strut in collision checks and pictures
  Play play;
  Masses masses;
  ScrewRotation screw_rotation = ScrewRotation::guided;
};

/// What an axis of an open chain carries: a rigid body, told in the chain's frame O with all axes at 0.
struct Link {
  double mass = 0;                      ///< [kg]
  Vec3 centre_O{0, 0, 0};               ///< [m]
  Mat3 inertia_O = Mat3::Zero();        ///< [kg m^2], about the centre, along O's axes
  std::vector<geometry::Shape> bodies;  ///< poses in O
};

/// Of a chain whose tool hangs on rods (kinematics/chain/rods.h), in parallel pairs.
struct Rods {
  double mass = 0;         ///< [kg], of a pair
  double radius = 0;       ///< [m], of one rod
  double spacing = 0;      ///< [m], between the two of a pair
  double tool_offset = 0;  ///< [m], of a pair's joints on the tool, from its middle towards the pair's slide
  double carried = 0;      ///< [kg], what hangs on all of them, tool included
};

/// An open chain: arm, five-axis table, finishing stage, or any other tree of axes. Its frame O stands still
/// and upright: gravity is along -z.
struct ChainModel {
  kinematics::ChainDescription kinematics;
  std::vector<Link> links;                    ///< one an axis; the tool belongs to the last of its branch
  Rods rods;                                  ///< where kinematics.chain has them; the tool hangs on those
  kinematics::AxisVector play{};              ///< [m] or [rad], total free travel of each axis; nominal
  kinematics::AxisVector friction{};          ///< [N] or [N m], below which an axis stays within its play
  std::vector<geometry::Shape> frame_bodies;  ///< what stands still; poses in O
};

struct Tool {
  double nozzle_diameter = 0;           ///< [m], bore; 0: an end mill, which prints nothing
  double flat_diameter = 0;             ///< [m], flat ring around the bore, or the end mill
  double filament_diameter = 0;         ///< [m]
  std::vector<geometry::Shape> bodies;  ///< nozzle cone, heater block, platform...; poses in T
  bool prints() const { return nozzle_diameter > 0; }
};

/// What happens to the filament between drive and part; the keys of section `process`, which may be left out.
struct Process {
  std::string material = "pla";         ///< a name under models/materials or a path of a material file
  double ambient_temperature = 298.15;  ///< [K]
  double fan_air_speed = 1;             ///< [m/s] past the strand, at full fan
  /// [m], diameter of a strand that leaves the nozzle freely; 0: 1.2 bores (Ishak 2018: 0.48 mm).
  double free_strand_diameter = 0;
  double extruder_lag = 0.03;  ///< [s], first-order, from the drive's feed to the flow at the nozzle
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

/// 1 sigma of the parameters of a built machine about the description.
struct ToleranceSet {
  // Hexapod: the 42 parameters.
  double joint_position = 0;  ///< [m], each coordinate of b_i and a_i
  double length_offset = 0;   ///< [m], l_i0
  // Open chain.
  double axis_position =
      0;  ///< [m], each coordinate of a point of an axis (turning, or with a rod), and of the tool's mount
  double axis_direction = 0;  ///< [rad], tilt of each axis about both directions across it
  double zero_length = 0;     ///< [m], zero of a sliding axis
  double zero_angle = 0;      ///< [rad], zero of a turning axis
  double rod_length = 0;      ///< [m], each rod of a chain with rods
};

/// 1 sigma of how laser and microscope sit on a built machine about their drawing.
struct MountingTolerances {
  double position = 0;  ///< [m], each coordinate of each device
  double angle = 0;     ///< [rad], of each device about each of its own axes
  double scale = 0;     ///< of the picture, a share of it
};

struct Tolerances {
  ToleranceSet manufactured;                   ///< before any calibration
  ToleranceSet after_calibration;              ///< left after the paper's calibration
  std::optional<MountingTolerances> mounting;  ///< nothing: not stated
};

/// What a machine file says of the calibration that its geometry comes from.
struct CalibrationRecord {
  std::string estimator;
  std::string measurements;         ///< name of the file that was measured
  std::string measurements_sha256;  ///< hexadecimal
  int poses = 0;
  /// [m], RMS over the work space of the tip's 3D uncertainty; NaN: not known, of a plug-in's calibration.
  double tip_sigma = std::numeric_limits<double>::quiet_NaN();
};

/// Where laser and microscope sit, and how large the picture is.
struct OpticsMounting {
  Pose X_TL = Pose::Identity();
  Pose X_TC = Pose::Identity();
  double focal_px = 0;  ///< [px]
};

/// The freedoms of an OpticsMounting that its errors are told in, and the order of vectors and matrices of
/// them: offset of the laser along its own x and y [m], its turn about both [rad]; offset of the camera along
/// its own x, y and z [m], its turn about the three [rad]; scale of the picture, a share of it. Along its
/// beam and about it the laser may sit anyhow, and the principal point cannot be told from a turn of the
/// camera.
constexpr int kMountingFreedoms = 11;
using MountingVector = Eigen::Matrix<double, kMountingFreedoms, 1>;
using MountingMatrix = Eigen::Matrix<double, kMountingFreedoms, kMountingFreedoms>;

/// Of a beam whose waist, in `laser`, is the one that its dots show.
struct MeasuredWaist {
  double drawn = 0;  ///< [m], as the file's section `laser` has it
  double sigma = 0;  ///< [m], of the one that was measured
};

/// What a machine file says of the calibration that `laser` and `microscope` come from.
struct GapSensorCalibration {
  OpticsMounting drawn;             ///< as the file's sections `laser` and `microscope` have them
  std::string measurements;         ///< name of the table of pictures
  std::string measurements_sha256;  ///< hexadecimal
  int pictures = 0;
  /// Of the errors of the calibrated mounting; symmetric, positive semi-definite.
  MountingMatrix covariance = MountingMatrix::Zero();
  std::optional<MeasuredWaist> waist;  ///< empty: nobody measured it, the drawn one counts
};

/// The gap between tip and surface (Song 2015, 3.3).
struct GapLimits {
  double accepted_min = 0;  ///< [m]
  double accepted_max = 0;  ///< [m]; a bead laid higher does not stick
  double aim = 0;           ///< [m]
  double standoff = 0;      ///< [m], S' out along the normal from S
};

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

struct MachineDescription {
  std::string name;
  std::string mechanism;       ///< kinematics::kHexapod, or the name of a ChainKind
  std::filesystem::path file;  ///< where it was read, with the values that its word changes in braces
  std::string sha256;          ///< of the file's bytes and these changes, hexadecimal

  /// The mechanism's base B in the world. The world stands on the work: where axes move the table, W moves
  /// with it and X_WB is the identity.
  Pose X_WB = Pose::Identity();
  Pose X_BT_home = Pose::Identity();

  /// The closed loops of a hexapod, or an open chain.
  std::variant<HexapodModel, ChainModel> model;
  bool is_chain() const { return std::holds_alternative<ChainModel>(model); }
  /// Of a machine of that kind: elsewhere a mistake of the caller, std::bad_variant_access.
  const HexapodModel& hexapod() const { return std::get<HexapodModel>(model); }
  HexapodModel& hexapod() { return std::get<HexapodModel>(model); }
  const ChainModel& chain() const { return std::get<ChainModel>(model); }
  ChainModel& chain() { return std::get<ChainModel>(model); }
  /// The answer of the one that takes this machine's model: visit([](const HexapodModel&) {...}, [](const
  /// ChainModel&) {...}).
  template <typename... Cases>
  auto visit(Cases&&... cases) const {
    return std::visit(Overloaded{std::forward<Cases>(cases)...}, model);
  }
  /// Empty: the geometry is the drawn one.
  std::optional<CalibrationRecord> calibration;

  kinematics::PerAxis<Drive> drives{};  ///< one an axis
  Tool tool;
  Process process;             ///< of a tool that prints
  ProgramDialect dialect;      ///< of its programs
  bool has_microscope = true;  ///< with its laser; without, there is no gap control
  Laser laser;                 ///< what the controller reckons with: calibrated where it was
  Microscope microscope;       ///< likewise
  std::optional<GapSensorCalibration> gap_sensor;  ///< empty: laser and microscope are the drawn ones
  Tolerances tolerances;
  GapLimits gap;
  geometry::Shape table;            ///< pose in W; its top is z = 0
  double cycle_time = 0;            ///< [s], period of the setpoints that a port takes
  double travel_velocity = 0;       ///< [m/s], tip speed of G0
  double orientation_velocity = 0;  ///< [rad/s], limit of the tool's angular speed
  double acceleration = 0;          ///< [m/s^2], of the tip along the path
  ControlSettings control;          ///< gains and limits of the controller

  std::unique_ptr<kinematics::Mechanism> make_mechanism() const;
  /// How the joints turn the screws of a hexapod; lead 0 where rails guide them.
  kinematics::ScrewCoupling screw_coupling() const;
  /// Axis positions at which the drives read 0: l_i0 of a strut, 0 of a chain's axis. [m] or [rad]
  kinematics::AxisVector drive_zero() const;
  /// The description gives this axis, or its strut, any play.
  bool has_play(int axis) const;
  /// [m], at most, by which all play together may shift the tip near home along any direction.
  double tip_play() const;
};

/// `name_or_path` is a folder name under the models folder or a path of a machine.yaml (or its folder), and
/// may change values of the file: `hexapod{gap.aim_mm: 0.14}` (core/yaml/changed_file.h). Throws InputError
/// with file, line and the key's name for unknown, missing or misspelt keys (naming the nearest known one),
/// values of the wrong type or unit and impossible values (with the limit).
MachineDescription load_machine(const std::string& name_or_path);

/// Folder with the shipped models: $UNDERSTUDY_MODELS, the installed one beside the program, or the source
/// tree's.
std::filesystem::path models_folder();

/// Names under models_folder() that hold a machine.yaml, sorted.
std::vector<std::string> machine_names();

}  // namespace understudy::machine
