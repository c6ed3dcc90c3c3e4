// A joint held within its play about a side that moves: the motor's, or the body that carries the joint.
// Private to this room.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include "sim/plant/bullet/bullet_tree.h"

namespace understudy::sim {

/// Share of a position error that one step removes (docs/reference.md#bullet).
constexpr double kErrorReduction = 0.8;

/// Inelastic stops at -travel/2 and +travel/2 of the joint's position against the side, or a rigid coupling
/// without travel. A stop acts within the step that would pass it: what is left of the gap may still be
/// crossed, v >= -gap/dt (Stewart and Trinkle 1996), so that nothing bounces and nothing passes.
class BulletPlay final : public btMultiBodyConstraint {
 public:
  struct Properties {
    double travel = 0;    ///< [m] or [rad], total
    double damping = 0;   ///< [N s/m] or [N m s/rad], within the travel
    double friction = 0;  ///< [N] or [N m]
  };
  /// With `rotor`, its first joint is the side; else set_side() gives it.
  BulletPlay(btMultiBody& tree, int link, btMultiBody* rotor, const Properties& properties);

  void set_side(double position, double velocity);
  void set_travel(double travel) { properties_.travel = travel; }
  /// The side lets go: it follows the joint without force.
  void set_free() { free_ = true; }
  bool is_free() const { return free_; }
  /// Added to the side's position: what the side itself does not show.
  void set_offset(double offset) { offset_ = offset; }

  double position() const;  ///< [m] or [rad], of the joint against the side, between -travel/2 and travel/2
  double overrun() const;   ///< [m] or [rad], beyond that
  double force(double timestep) const;  ///< [N] or [N m], on the joint by the side during the last step

  void finalizeMultiDof() override {}
  int getIslandIdA() const override { return -1; }
  int getIslandIdB() const override { return -1; }
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void debugDraw(btIDebugDraw*) override {}

 private:
  enum Row { kLowerStop, kUpperStop, kDamping, kFriction, kRows };
  struct Target {
    double velocity;      ///< of the joint against the side, times sign
    double sign;          ///< of the row's force on the joint
    double lower, upper;  ///< [N s], of the impulse
    double softness = 0;  ///< [1/kg], velocity that an impulse leaves
  };
  void add_row(Row row, const Target& target, btMultiBodyConstraintArray& rows,
               btMultiBodyJacobianData& data);
  double side_position() const;

  Properties properties_;
  double side_position_ = 0, side_velocity_ = 0, offset_ = 0;
  bool free_ = false;
};

}  // namespace understudy::sim
