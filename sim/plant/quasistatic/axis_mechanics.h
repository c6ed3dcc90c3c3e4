// What the quasistatic plant asks of a machine: where the tool is for true axis positions, and what its axes
// have to push. Private to this room.
#pragma once

#include <memory>
#include <string>

#include "kinematics/mechanism.h"
#include "sim/as_built/as_built.h"
#include "sim/plant/plant.h"
#include "sim/plant/quasistatic/backlash_dynamics.h"

namespace understudy::sim {

/// Axis positions are true ones: behind drive, growth, deflection and play; strut lengths for a hexapod.
/// Keeps the last pose as the start of the next solution. Nothing here throws or allocates.
class AxisMechanics {
 public:
  virtual ~AxisMechanics() = default;

  virtual int axis_count() const = 0;
  virtual std::string axis_name(int axis) const = 0;
  /// True position of an axis whose drive reads 0.
  virtual double axis_zero(int axis) const = 0;
  /// As built, in units of the axis' position.
  virtual SeriesPlay built_play(int axis) const = 0;
  virtual kinematics::AxisVector home() const = 0;  ///< true axis positions

  /// Forgets the last pose.
  virtual void start_from_home() = 0;
  virtual kinematics::SolveStatus place(const AxisVector& position) = 0;
  virtual Pose tool_pose() const = 0;        ///< X_WT where it was placed last
  virtual double closure_error() const = 0;  ///< [m], largest residual there

  /// Inverse dynamics where it was placed last. `singular` where no axis force holds the machine.
  virtual kinematics::SolveStatus load(const AxisVector& velocity, const AxisVector& acceleration,
                                       AxisLoad& load) = 0;
  /// Of the axes, where it was placed and loaded last.
  virtual void mass_matrix(AxisMatrix& mass) const = 0;
};

std::unique_ptr<AxisMechanics> make_hexapod_mechanics(const machine::MachineDescription& machine,
                                                      const AsBuilt& as_built,
                                                      const QuasistaticOptions& options);
std::unique_ptr<AxisMechanics> make_chain_mechanics(const machine::MachineDescription& machine,
                                                    const AsBuilt& as_built,
                                                    const QuasistaticOptions& options);
/// Of a chain whose tool hangs on rods.
std::unique_ptr<AxisMechanics> make_rod_mechanics(const machine::MachineDescription& machine,
                                                  const AsBuilt& as_built, const QuasistaticOptions& options);

}  // namespace understudy::sim
