// An arm of two turning axes with collision shapes of every kind, and a machine file for it.
#pragma once

#include <filesystem>
#include <string>

#include "core/file/output_file.h"

namespace understudy::machine {

/// Links base, upper (box, cylinder), fore (sphere, mesh "fore.obj" of a package) and tool; no masses but
/// upper's.
inline constexpr const char* kArmWithShapes = R"(<robot name="shapes">
<link name="base"><collision><geometry><cylinder radius="0.05" length="0.1"/></geometry></collision></link>
<link name="upper">
  <inertial><mass value="2"/><origin xyz="0 0 0.2"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.003"/></inertial>
  <collision><origin xyz="0 0 0.2"/><geometry><box size="0.06 0.06 0.3"/></geometry></collision>
  <collision><geometry><cylinder radius="0.04" length="0.1"/></geometry></collision>
</link>
<link name="fore">
  <collision><origin xyz="0 0 0.05"/><geometry><sphere radius="0.03"/></geometry></collision>
  <collision><geometry><mesh filename="package://arms/meshes/fore.obj" scale="0.001 0.001 0.001"/></geometry></collision>
</link>
<link name="tool"/>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" effort="10" velocity="2"/></joint>
<joint name="b" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="10" velocity="2"/></joint>
<joint name="t" type="fixed"><parent link="fore"/><child link="tool"/><origin xyz="0 0 0.3"/></joint>
</robot>
)";

/// A block from (-20, -20, 0) to (20, 20, 250), in millimetres.
inline constexpr const char* kForeMesh = R"(v -20 -20 0
v 20 -20 0
v -20 20 0
v 20 20 0
v -20 -20 250
v 20 -20 250
v -20 20 250
v 20 20 250
f 1 3 4
f 1 4 2
f 5 6 8
f 5 8 7
f 1 2 6
f 1 6 5
f 3 7 8
f 3 8 4
f 1 5 7
f 1 7 3
f 2 4 8
f 2 8 6
)";

inline constexpr const char* kArmWithShapesFile = R"(name: shapes
mechanism: chain
geometry:
  urdf: arm.urdf
  base_link: base
  tool_link: tool
  tip_mm: [0, 0, 100]
  tool_direction: [0, 0, -1]
  base_mm: [0, 0, 0]
  base_turn_deg: 0
conditioning: {length_scale_mm: 300}
axes:
  - {name: a, home_deg: 0, play_arcmin: 0.5, drive: {lead_deg: 3.6, steps_per_turn: 8192, microsteps: 1, velocity_max_deg_per_s: 90, acceleration_max_deg_per_s2: 400}}
  - {name: b, home_deg: 60, play_arcmin: 0.5, drive: {lead_deg: 3.6, steps_per_turn: 8192, microsteps: 1, velocity_max_deg_per_s: 90, acceleration_max_deg_per_s2: 400}}
tool: {nozzle_diameter_mm: 0.4, flat_diameter_mm: 1, filament_diameter_mm: 1.75, bodies: [{name: nozzle, shape: frustum, bottom_centre_mm: [0, 0, 0], radius_bottom_mm: 0.5, radius_top_mm: 3.5, height_mm: 12}]}
tolerances:
  manufactured: {axis_position_mm: 0.2, axis_direction_deg: 0.02, zero_mm: 0, zero_deg: 0.05}
  after_calibration: {axis_position_mm: 0.03, axis_direction_deg: 0.003, zero_mm: 0, zero_deg: 0.003}
gap: {accepted_min_mm: 0.10, accepted_max_mm: 0.20, aim_mm: 0.13, standoff_mm: 2}
table: {size_mm: [200, 200, 10]}
motion: {cycle_ms: 1, travel_mm_per_s: 75, orientation_deg_per_s: 60, acceleration_mm_per_s2: 500}
)";

/// All of it in a folder, the mesh at `mesh`; the machine file with `from` replaced by `to`. The machine
/// file's path.
inline std::string write_arm_with_shapes(const std::filesystem::path& folder,
                                         const std::string& mesh = "arms/meshes/fore.obj",
                                         const std::string& from = "", const std::string& to = "") {
  std::filesystem::create_directories((folder / mesh).parent_path());
  write_file(folder / mesh, kForeMesh);
  write_file(folder / "arm.urdf", kArmWithShapes);
  std::string text = kArmWithShapesFile;
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  write_file(folder / "machine.yaml", text);
  return (folder / "machine.yaml").string();
}

}  // namespace understudy::machine
