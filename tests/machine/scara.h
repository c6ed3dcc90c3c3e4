// A fifth machine that is nothing but a file: a SCARA with a printing head, its axes listed. Every body, play
// and drive is told, so that kinematics, plants and pictures have all they need.
#pragma once

namespace understudy {

inline constexpr const char* kScara = R"(name: scara
mechanism: chain
geometry:
  base_mm: [-250, 0, 0]
  base_turn_deg: 0
  tip_mm: [400, 0, 100]
  tool_direction: [0, 0, 1]
  tool_carried_by: quill
  work_carried_by: frame
conditioning:
  length_scale_mm: 200
axes:
  - name: shoulder
    moves: turns
    direction: [0, 0, 1]
    point_mm: [0, 0, 300]
    carried_by: frame
    range_deg: [-140, 140]
    home_deg: 40
    drive: {lead_deg: 3.6, steps_per_turn: 4000, microsteps: 1, velocity_max_deg_per_s: 200, acceleration_max_deg_per_s2: 1000}
    play_arcmin: 0.5
    friction_newton_metre: 0.2
    link: {mass_kg: 3, centre_mm: [100, 0, 300], inertia_kg_mm2: [4000, 30000, 30000], bodies: [{name: upper arm, shape: capsule, from_mm: [0, 0, 300], to_mm: [200, 0, 300], radius_mm: 40}]}
  - name: elbow
    moves: turns
    direction: [0, 0, 1]
    point_mm: [200, 0, 300]
    carried_by: shoulder
    range_deg: [-150, 150]
    home_deg: -80
    drive: {lead_deg: 3.6, steps_per_turn: 4000, microsteps: 1, velocity_max_deg_per_s: 300, acceleration_max_deg_per_s2: 1500}
    play_arcmin: 0.5
    friction_newton_metre: 0.1
    link: {mass_kg: 2, centre_mm: [300, 0, 300], inertia_kg_mm2: [2000, 15000, 15000], bodies: [{name: forearm, shape: capsule, from_mm: [200, 0, 300], to_mm: [400, 0, 300], radius_mm: 30}]}
  - name: wrist
    moves: turns
    direction: [0, 0, 1]
    point_mm: [400, 0, 300]
    carried_by: elbow
    range_deg: [-360, 360]
    home_deg: 40
    drive: {lead_deg: 3.6, steps_per_turn: 4000, microsteps: 1, velocity_max_deg_per_s: 600, acceleration_max_deg_per_s2: 3000}
    play_arcmin: 0.5
    friction_newton_metre: 0.02
    link: {mass_kg: 0.3, centre_mm: [400, 0, 250], inertia_kg_mm2: [100, 100, 100]}
  - name: quill
    moves: slides
    direction: [0, 0, 1]
    carried_by: wrist
    range_mm: [-105, 60]
    home_mm: -50
    drive: {lead_mm: 8, steps_per_turn: 200, microsteps: 16, velocity_max_mm_per_s: 100, acceleration_max_mm_per_s2: 2000, self_locking: yes}
    play_um: 20
    link: {mass_kg: 0.5, centre_mm: [400, 0, 200], inertia_kg_mm2: [800, 800, 100]}
tool:
  nozzle_diameter_mm: 0.4
  flat_diameter_mm: 1.0
  filament_diameter_mm: 1.75
  bodies:
    - {name: nozzle, shape: frustum, bottom_centre_mm: [0, 0, 0], radius_bottom_mm: 0.5, radius_top_mm: 3.5, height_mm: 12}
tolerances:
  manufactured: {axis_position_mm: 0.2, axis_direction_deg: 0.02, zero_mm: 0.1, zero_deg: 0.05}
  after_calibration: {axis_position_mm: 0.03, axis_direction_deg: 0.003, zero_mm: 0.01, zero_deg: 0.003}
gap:
  accepted_min_mm: 0.10
  accepted_max_mm: 0.30
  aim_mm: 0.20
  standoff_mm: 2
table:
  size_mm: [200, 200, 10]
motion:
  cycle_ms: 1
  travel_mm_per_s: 75
  orientation_deg_per_s: 60
  acceleration_mm_per_s2: 500
)";

}  // namespace understudy
