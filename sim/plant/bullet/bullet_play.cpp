#include "sim/plant/bullet/bullet_play.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::sim {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::max();

/// Appends a body's part of a row: d(row velocity)/d(joint velocities) and what a unit impulse does to them.
/// Returns their product, the inverse of the mass that the row feels.
double add_jacobian(btMultiBody& body, int link, double sign, int& velocity_index, int& jacobian_index,
                    btMultiBodyJacobianData& data) {
  const int size = body.getNumDofs() + 6;
  velocity_index = body.getCompanionId();
  if (velocity_index < 0) {
    velocity_index = data.m_deltaVelocities.size();
    body.setCompanionId(velocity_index);
    data.m_deltaVelocities.resize(velocity_index + size, 0.0);
  }
  jacobian_index = data.m_jacobians.size();
  data.m_jacobians.resize(jacobian_index + size, 0.0);
  data.m_deltaVelocitiesUnitImpulse.resize(jacobian_index + size, 0.0);
  for (int i = 0; i < size; ++i) data.m_jacobians[jacobian_index + i] = 0;
  const int joint = jacobian_index + 6 + body.getLink(link).m_dofOffset;
  data.m_jacobians[joint] = sign;
  body.calcAccelerationDeltasMultiDof(&data.m_jacobians[jacobian_index],
                                      &data.m_deltaVelocitiesUnitImpulse[jacobian_index], data.scratch_r,
                                      data.scratch_v);
  return sign * data.m_deltaVelocitiesUnitImpulse[joint];
}

}  // namespace

BulletPlay::BulletPlay(btMultiBody& tree, int link, btMultiBody* rotor, const Properties& properties)
    : btMultiBodyConstraint(&tree, rotor, link, rotor == nullptr ? -1 : 0, kRows, true,
                            MULTIBODY_CONSTRAINT_LIMIT),
      properties_(properties) {
  m_data.resize(kRows, 0.0);  // the impulses
}

void BulletPlay::set_side(double position, double velocity) {
  side_position_ = position;
  side_velocity_ = velocity;
}

double BulletPlay::side_position() const {
  return offset_ + (m_bodyB == nullptr ? side_position_ : m_bodyB->getJointPos(0));
}

double BulletPlay::position() const { return m_bodyA->getJointPos(m_linkA) - side_position(); }

double BulletPlay::overrun() const {
  return free_ ? 0.0 : std::max(0.0, std::abs(position()) - properties_.travel / 2);
}

double BulletPlay::force(double timestep) const {
  return (m_data[kLowerStop] - m_data[kUpperStop] + m_data[kDamping] + m_data[kFriction]) / timestep;
}

void BulletPlay::add_row(Row row, const Target& target, btMultiBodyConstraintArray& rows,
                         btMultiBodyJacobianData& data) {
  btMultiBodySolverConstraint& c = rows.expandNonInitializing();
  c = btMultiBodySolverConstraint();
  c.m_orgConstraint = this;
  c.m_orgDofIndex = row;
  c.m_multiBodyA = m_bodyA;
  c.m_linkA = m_linkA;
  c.m_multiBodyB = m_bodyB;
  c.m_linkB = m_linkB;
  for (btVector3* v : {&c.m_relpos1CrossNormal, &c.m_contactNormal1, &c.m_relpos2CrossNormal,
                       &c.m_contactNormal2, &c.m_angularComponentA, &c.m_angularComponentB})
    v->setZero();
  double admittance = add_jacobian(*m_bodyA, m_linkA, target.sign, c.m_deltaVelAindex, c.m_jacAindex, data);
  double velocity = target.sign * m_bodyA->getJointVel(m_linkA);
  if (m_bodyB != nullptr) {
    admittance += add_jacobian(*m_bodyB, 0, -target.sign, c.m_deltaVelBindex, c.m_jacBindex, data);
    velocity -= target.sign * m_bodyB->getJointVel(0);
  } else {
    velocity -= target.sign * side_velocity_;
  }
  c.m_jacDiagABInv = 1 / (admittance + target.softness);
  c.m_rhs = (target.velocity - velocity) * c.m_jacDiagABInv;
  c.m_cfm = target.softness * c.m_jacDiagABInv;
  c.m_lowerLimit = target.lower;
  c.m_upperLimit = target.upper;
  c.m_appliedImpulse = 0;
  c.m_appliedPushImpulse = 0;
  c.m_rhsPenetration = 0;
  c.m_friction = 0;
  c.m_frictionIndex = 0;
  c.m_overrideNumSolverIterations = 0;
}

void BulletPlay::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                      const btContactSolverInfo& info) {
  const double dt = info.m_timeStep, half = properties_.travel / 2, p = position();
  if (free_) {
    for (int row = 0; row < kRows; ++row) m_data[row] = 0;
    return;
  }
  if (properties_.travel <= 0) {
    add_row(kLowerStop, {-kErrorReduction * p / dt, 1, -kUnlimited, kUnlimited}, rows, data);
    m_data[kUpperStop] = m_data[kDamping] = m_data[kFriction] = 0;
    return;
  }
  const auto approach = [&](double gap) { return -(gap > 0 ? 1.0 : kErrorReduction) * gap / dt; };
  add_row(kLowerStop, {approach(p + half), 1, 0, kUnlimited}, rows, data);
  add_row(kUpperStop, {approach(half - p), -1, 0, kUnlimited}, rows, data);
  // Damping as a row, so that it is implicit and stable however light the part is.
  if (properties_.damping > 0)
    add_row(kDamping, {0, 1, -kUnlimited, kUnlimited, 1 / (properties_.damping * dt)}, rows, data);
  else
    m_data[kDamping] = 0;
  const double slip = properties_.friction * dt;
  if (slip > 0)
    add_row(kFriction, {0, 1, -slip, slip}, rows, data);
  else
    m_data[kFriction] = 0;
}

}  // namespace understudy::sim
