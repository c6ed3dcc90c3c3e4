// What a user asks of a rehearsal, as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/program/dialect_request.h"
#include "machine/default_machine.h"
#include "rehearsal/request/fault_request.h"
#include "sim/as_built/truth_seeds.h"

namespace understudy::rehearsal {

using control::DialectRequest;
using control::RobotProgramRequest;

/// What is asked about the surface as printed (docs/surface.md).
struct SurfaceRequest {
  std::string as_printed;               ///< .stl or .ply to write; empty: none
  std::string intended;                 ///< STL that the print was to become, or a name under models/parts
  std::vector<double> profile_mm;       ///< line from, to: six numbers in W; empty: none
  std::vector<double> probe{0, 0, -1};  ///< direction in which the line looks for the surface
  // Of a machine that mills `intended` out of a stock (docs/removal.md): one of these two.
  std::optional<double> depth_of_cut_mm;  ///< the stock is `intended`, larger by this
  std::string stock;                      ///< STL of the stock, or a name under models/parts; empty: none
};

/// Whether the part is found by the gap sensor before the print (docs/registration.md).
struct RegistrationRequest {
  bool wanted = false;
  std::string pattern;  ///< CSV of places; empty: chosen
  int places = 9;       ///< of the chosen ones
};

struct RehearsalRequest {
  std::string program;  ///< path of G-code, KRL or RAPID; empty: nothing is printed
  std::string machine = machine::kDefaultMachine;  ///< name or path
  /// Where the axes of a chain stand at home [mm or deg]: another posture of an arm than the machine file's;
  /// empty: that.
  std::vector<double> home_axes;
  std::string before;  ///< the machine before its calibration, name or path; empty: no comparison
  std::string engine = "mujoco";
  std::string fixture;   ///< STL path, a name under models/parts, or empty: only the table
  std::string material;  ///< name or path; empty: the machine's
  std::string as_built;  ///< of sim::make_as_built; empty: sim::default_as_built
  std::uint64_t seed = 1;
  std::optional<sim::TruthSeeds> truth_seeds;  ///< of each group of truths; nothing: `seed` of all
  std::string gap_control;  ///< off, start, continuous; empty: start on a machine that sees, else off
  /// Largest true errors of a print that is good; without one, the machine file's.
  std::optional<double> tip_tolerance_mm, orientation_tolerance_deg;
  std::vector<FaultRequest> faults;               ///< what goes wrong with the machine on the way
  std::vector<CameraFaultRequest> camera_faults;  ///< and with its gap sensor
  DialectRequest dialect;
  SurfaceRequest surface;
  RegistrationRequest registration;
  std::string record;     ///< file of what goes through the port to write (docs/port-record.md); empty: none
  std::string part_pose;  ///< file of `register`: where the part stands; empty: as drawn, or found
  std::string command;    ///< for the record: how a user repeats this
  double max_time = 86400;  ///< [s], of the program; what would take longer is refused
  bool keep_scene = true;   ///< keep what pictures are drawn from; sweeps leave it out
  bool compare_without_gap_control =
      true;  ///< run the print again with gap control off, for open-loop figures
};

}  // namespace understudy::rehearsal
