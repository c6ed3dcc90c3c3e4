#include "sim/plant/bullet/bullet_plant_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "sim/plant/joint_constants.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

double rotor_damping(const machine::Drive& drive) {
  return 2 * drive.damping_ratio * std::sqrt(drive.stiffness * drive.rotor());
}

/// The rotor of an elastic drive: it turns and does not travel, so it is a body of its own, which the axis'
/// inertia meets only in the joint.
std::unique_ptr<btMultiBody> make_rotor(double inertia, double position) {
  BulletLink link;
  link.angle = false;
  link.mass = inertia;
  auto rotor = make_tree({link}, Pose::Identity());
  rotor->setJointPos(0, position);
  return rotor;
}

}  // namespace

BulletPlantBase::BulletPlantBase(const machine::MachineDescription& machine, const BulletOptions& options)
    : machine_(machine), options_(options) {
  check_timestep(machine, options.timestep);
  if (options.iterations < 1)
    throw InputError(fmt::format("iterations of the solver are {}, not above 0", options.iterations));
}

std::string BulletPlantBase::engine() const {
  return fmt::format("bullet {}.{:02}", btGetVersion() / 100, btGetVersion() % 100);
}

void BulletPlantBase::clear() {
  failed_ = true;
  solved_.clear();
  constraints_.clear();
  damped_.clear();
  drives_.clear();
  bodies_.clear();
  has_weight_.clear();
  solver_ = std::make_unique<BulletSolver>(options_.iterations);
  steps_ = 0;
}

btMultiBody& BulletPlantBase::add_body(std::unique_ptr<btMultiBody> body, bool weight) {
  bodies_.push_back(std::move(body));
  has_weight_.push_back(weight);
  return *bodies_.back();
}

btMultiBodyConstraint& BulletPlantBase::add_constraint(std::unique_ptr<btMultiBodyConstraint> constraint) {
  constraints_.push_back(std::move(constraint));
  solved_.push_back(constraints_.back().get());
  return *constraints_.back();
}

void BulletPlantBase::add_drive(btMultiBody& tree, int link, double displacement, double zero,
                                const BulletPlay::Properties& play) {
  const machine::Drive& described = machine_.drives[drives_.size()];
  Drive drive;
  drive.zero = zero;
  drive.play_built = play.travel;
  drive.position = drive.spring_position = displacement;
  if (described.stiffness > 0) drive.rotor = &add_body(make_rotor(described.rotor(), displacement), false);
  auto constraint = std::make_unique<BulletPlay>(tree, link, drive.rotor, play);
  drive.play = constraint.get();
  add_constraint(std::move(constraint));
  drives_.push_back(drive);
}

double BulletPlantBase::largest_speed() const {
  double largest = 0;
  for (const auto& body : bodies_)
    for (int i = 0; i < 6 + body->getNumDofs(); ++i)
      largest = std::max(largest, std::abs(body->getVelocityVector()[i]));
  return largest;
}

void BulletPlantBase::settle(const AxisVector& displacement) {
  failed_ = false;
  DriveCommand hold;
  hold.position = displacement;
  double still_since = 0;
  while (time() - still_since < kSettledTime && time() < kSettleCap) {
    step(hold);
    if (largest_speed() > kSettledSpeed) still_since = time();
  }
  if (largest_speed() > kFloatingSpeed) {
    failed_ = true;
    throw MachineError(fmt::format("the machine does not come to rest within {} s", kSettleCap));
  }
  steps_ = 0;
}

AxisVector BulletPlantBase::displacement() const {
  AxisVector displacement{};
  for (std::size_t i = 0; i < drives_.size(); ++i)
    displacement[i] = drives_[i].rotor != nullptr ? drives_[i].rotor->getJointPos(0) : drives_[i].position;
  return displacement;
}

AxisVector BulletPlantBase::drive_force() const {
  AxisVector force{};
  for (std::size_t i = 0; i < drives_.size(); ++i) force[i] = drives_[i].play->force(options_.timestep);
  return force;
}

void BulletPlantBase::set_condition(int axis, const AxisCondition& condition) {
  Drive& drive = drives_.at(static_cast<std::size_t>(axis));
  drive.play->set_travel(drive.play_built + condition.play_added);
  if (condition.released && drive.following) {
    drive.following = false;
    if (!machine_.drives[static_cast<std::size_t>(axis)].self_locking && drive.rotor == nullptr)
      drive.play->set_free();
  }
  drive.condition = condition;
}

void BulletPlantBase::turn_rotor(std::size_t axis) {
  const machine::Drive& described = machine_.drives[axis];
  const Drive& drive = drives_[axis];
  if (!drive.following && !described.self_locking) return;
  const double behind = drive.spring_position - drive.rotor->getJointPos(0),
               slower = drive.spring_velocity - drive.rotor->getJointVel(0);
  drive.rotor->addJointTorque(0, described.stiffness * behind + rotor_damping(described) * slower);
}

void BulletPlantBase::command_drives(const DriveCommand& command) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    Drive& drive = drives_[i];
    drive.velocity = drive.spring_velocity = 0;
    if (drive.following) {
      const double position = command.position[i], velocity = command.velocity[i];
      if (!std::isfinite(position + velocity))
        throw MachineError(
            fmt::format("drive {} is commanded to a position that is not finite at {:.4f} s", i + 1, time()));
      drive.hidden = drive.condition.growth + hidden_travel(static_cast<int>(i));
      drive.velocity = velocity + kErrorReduction * (position - drive.position) / options_.timestep;
      drive.spring_position = position;
      drive.spring_velocity = velocity;
    }
    drive.play->set_offset(drive.zero + drive.hidden);
    if (drive.rotor != nullptr)
      turn_rotor(i);
    else
      drive.play->set_side(drive.position, drive.velocity);
  }
}

void BulletPlantBase::integrate() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    btMultiBody& body = *bodies_[b];
    body.clearConstraintForces();
    body.setCompanionId(-1);  // the solver numbers bodies anew each time
    if (has_weight_[b]) {
      body.addBaseForce(to_bullet(gravity_W_) * body.getBaseMass());
      for (int i = 0; i < body.getNumLinks(); ++i)
        body.addLinkForce(i, to_bullet(gravity_W_) * body.getLinkMass(i));
    }
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(options_.timestep, scratch_r_, scratch_v_,
                                                              scratch_m_, false, false, false);
    body.clearForcesAndTorques();
  }
  btContactSolverInfo info;
  info.m_timeStep = options_.timestep;
  info.m_erp = info.m_erp2 = kErrorReduction;
  info.m_solverMode = 0;
  solver_->solveMultiBodyGroup(nullptr, 0, nullptr, 0, nullptr, 0, solved_.data(),
                               static_cast<int>(solved_.size()), info, nullptr, nullptr);
  if (!solver_->solved())
    throw MachineError(
        fmt::format("engine failure at {:.4f} s: no impulses satisfy stops and closures within {} pivots",
                    time(), options_.iterations));
  for (const auto& body : bodies_) {
    body->processDeltaVeeMultiDof2();
    body->stepPositionsMultiDof(options_.timestep);
  }
}

void BulletPlantBase::move_motors() {
  for (Drive& drive : drives_) {
    if (drive.rotor != nullptr) continue;
    drive.position += options_.timestep * drive.velocity;
    drive.play->set_side(drive.position, drive.velocity);
    if (drive.following) continue;
    // A motor that is free is drawn along by the end of the play.
    const double half = (drive.play_built + drive.condition.play_added) / 2, p = drive.play->position();
    if (drive.play->is_free()) drive.position += p - std::clamp(p, -half, half);
  }
}

void BulletPlantBase::check_state(const DriveCommand& command) const {
  check_assembly();
  const AxisVector reached = displacement();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    const double beyond = drive.play->overrun();
    if (!(beyond <= kClosureLimit))
      throw MachineError(
          fmt::format("engine failure at {:.4f} s: axis {} is {:.4f}e-3 beyond its play, limit {}e-3", time(),
                      i + 1, 1e3 * beyond, 1e3 * kClosureLimit));
    if (!drive.following) continue;
    // The command belongs to the step's beginning, the state to its end.
    const double due = command.position[i] + options_.timestep * command.velocity[i];
    const double error = std::abs(reached[i] - due);
    // An elastic drive loses its step when the rotor leaves its field: that is a machine's failure as well.
    const machine::Drive& described = machine_.drives[i];
    const double limit = drive.rotor == nullptr
                             ? kFollowingLimit
                             : std::max(kFollowingLimit, described.lead / described.steps_per_turn);
    if (!(error <= limit))
      throw MachineError(
          fmt::format("engine failure at {:.4f} s: drive {} is {:.4f}e-3 from its command, limit {}e-3",
                      time(), i + 1, 1e3 * error, 1e3 * limit));
  }
}

void BulletPlantBase::step(const DriveCommand& command) {
  if (failed_) throw MachineError("engine failure: the plant has failed before and was not reset");
  failed_ = true;
  command_drives(command);
  for (const auto& body : bodies_) body->forwardKinematics(scratch_q_, scratch_v_);
  before_step();
  for (const DampedJoint& joint : damped_)
    joint.tree->addJointTorque(joint.link, -joint.damping * joint.tree->getJointVel(joint.link));
  integrate();
  move_motors();
  if (!std::isfinite(largest_speed()))
    throw MachineError(fmt::format("engine failure at {:.4f} s: a velocity is not finite", time()));
  check_state(command);
  ++steps_;
  failed_ = false;
}

}  // namespace understudy::sim
