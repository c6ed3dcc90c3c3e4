// The motions of docs/reference.md#physics-engines on which the engines are compared, as one stream of drive
// commands for all of them, and what is read from a plant that runs them. Shared by bench and tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/plant/plant.h"

namespace understudy::sim {

struct ReferenceMotion {
  std::string name;
  double duration = 0;               ///< [s]
  std::function<Pose(double)> X_BT;  ///< tool pose at a time [s]; at rest before 0
};

/// 20 mm circle at 15 degrees tilt in 2 s, begun and ended slowly.
ReferenceMotion circle_at_15_degrees(const machine::MachineDescription& machine);
/// Tilts about the tip to 20 degrees and back, 20 mm beside home: so far that struts change their load.
ReferenceMotion tilt_sweep(const machine::MachineDescription& machine);
/// Twelve strokes of 16 mm along x, reversed with at most `acceleration` [m/s^2], fed along y.
ReferenceMotion zigzag(const machine::MachineDescription& machine, double acceleration);
/// An arm's tool on a tilted circle of 60 mm radius while it swings by 20 degrees.
ReferenceMotion arm_path(const machine::MachineDescription& machine);

/// The nominal machine with this play: two thirds of `travel` in each nut and a third in each ball joint of a
/// hexapod [m]; all of it in each axis of an arm [rad].
AsBuilt built_with_play(const machine::MachineDescription& machine, double travel);

struct CommandStream {
  std::vector<DriveCommand> commands;  ///< at k timesteps
  std::vector<Vec3> tip_W;             ///< [m], commanded at k + 1 timesteps: where a step ends
  double largest_acceleration = 0;     ///< [m/s^2], of the commanded tip
};
/// Throws MachineError where the machine does not reach a pose.
CommandStream command_stream(const machine::MachineDescription& machine, const ReferenceMotion& motion,
                             double timestep);

/// What a plant did with a stream: one entry a step, at the step's end.
struct MotionTrace {
  std::vector<Vec3> tip_W;                   ///< [m]
  std::vector<kinematics::AxisVector> load;  ///< drive_force()
};
MotionTrace run(Plant& plant, const CommandStream& stream);

/// [m], between two tips at the same times.
std::vector<double> distances(const std::vector<Vec3>& a, const std::vector<Vec3>& b);
double peak(const std::vector<double>& distances);
double median(std::vector<double> distances);

/// How often the load of one of the first `axes` changed its side (sim/plant/load_flips.h).
int load_flips(const MotionTrace& trace, double timestep, int axes);

}  // namespace understudy::sim
