#include "sim/strand/strand_frame.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Cholesky>

#include "core/cross_matrix.h"
#include "core/error.h"

namespace understudy::sim {
StrandFrame::StrandFrame(const Section& section, const Vec3& start_W) : section_(section) {
  nodes_.push_back({start_W});
}

void StrandFrame::append(const Vec3& to_W) {
  elements_.push_back(make_element(to_W - nodes_.back().programmed));
  nodes_.push_back({to_W});
}

/// Euler-Bernoulli element of (displacement, rotation) at both ends; the load as consistent forces and
/// moments.
StrandFrame::Element StrandFrame::make_element(const Vec3& along) const {
  const double l = along.norm(), d2 = section_.diameter * section_.diameter;
  const double axial = section_.youngs_modulus * std::numbers::pi / 4 * d2 / l;
  const double bending = section_.youngs_modulus * std::numbers::pi / 64 * d2 * d2 / l;
  const double torsion = section_.shear_modulus * std::numbers::pi / 32 * d2 * d2 / l;
  const Vec3 t = along / l;
  const Mat3 tangential = t * t.transpose(), transverse = Mat3::Identity() - tangential;

  Element e;
  e.stiffness.setZero();
  e.torsion_stiffness.setZero();
  const Mat3 force = axial * tangential + 12 * bending / (l * l) * transverse;
  // Turning by w moves the line by (w x t) s, so that forces follow rotations by [t]x transposed.
  const Mat3 coupling = 6 * bending / l * cross_matrix(t);
  e.stiffness.block<3, 3>(0, 0) = e.stiffness.block<3, 3>(6, 6) = force;
  e.stiffness.block<3, 3>(0, 6) = e.stiffness.block<3, 3>(6, 0) = -force;
  for (const int turn : {3, 9}) {
    e.stiffness.block<3, 3>(0, turn) = -coupling;
    e.stiffness.block<3, 3>(6, turn) = coupling;
    e.stiffness.block<3, 3>(turn, 0) = -coupling.transpose();
    e.stiffness.block<3, 3>(turn, 6) = coupling.transpose();
    e.stiffness.block<3, 3>(turn, turn) = 4 * bending * transverse;
    e.torsion_stiffness.block<3, 3>(turn, turn) = torsion * tangential;
    e.stiffness.block<3, 3>(turn, 12 - turn) = 2 * bending * transverse;
    e.torsion_stiffness.block<3, 3>(turn, 12 - turn) = -torsion * tangential;
  }
  const Vec3 moment = l * l / 12 * t.cross(section_.load_W);
  e.load << l / 2 * section_.load_W, moment, l / 2 * section_.load_W, -moment;
  return e;
}

void StrandFrame::assemble(std::span<const double> creep) {
  diagonal_.assign(nodes_.size(), Mat6::Zero());
  below_.resize(elements_.size());
  right_.assign(nodes_.size(), Vector6::Zero());
  diagonal_[settled_] = settled_stiffness_;
  right_[settled_] = settled_force_;
  for (std::size_t i = settled_; i < elements_.size(); ++i) {
    Element& e = elements_[i];
    e.keep = 1 / (1 + section_.youngs_modulus * creep[i]);
    e.torsion_keep = 1 / (1 + 3 * section_.shear_modulus * creep[i]);
    // What is left of the forces at the end of the step if nothing moves; the motion's come after solve().
    e.force *= e.keep;
    e.torsion_force *= e.torsion_keep;
    const Matrix12 k = e.keep * e.stiffness + e.torsion_keep * e.torsion_stiffness;
    const Vector12 f = e.load - e.force - e.torsion_force;
    diagonal_[i] += k.topLeftCorner<6, 6>();
    diagonal_[i + 1] += k.bottomRightCorner<6, 6>();
    below_[i] = k.bottomLeftCorner<6, 6>();
    right_[i] += f.head<6>();
    right_[i + 1] += f.tail<6>();
  }
  if (settled_ == 0) fix(0, 6);
  for (std::size_t i = std::max<std::size_t>(settled_, 1); i < nodes_.size(); ++i)
    if (nodes_[i].supported) fix(i, 3);
  if (end_held_) fix(elements_.size(), 6);
}

/// The first `components` of a node's motion become 0.
void StrandFrame::fix(std::size_t node, int components) {
  const double unit = diagonal_[node].diagonal().maxCoeff();
  for (int c = 0; c < components; ++c) {
    diagonal_[node].row(c).setZero();
    diagonal_[node].col(c).setZero();
    diagonal_[node](c, c) = unit;
    if (node > settled_) below_[node - 1].row(c).setZero();
    if (node < elements_.size()) below_[node].col(c).setZero();
    right_[node][c] = 0;
  }
}

/// Block elimination from the settled elements to the end and all the way back.
void StrandFrame::solve() {
  const std::size_t last = elements_.size();
  Eigen::LLT<Mat6> factor;
  for (std::size_t i = settled_; i <= last; ++i) {
    factor.compute(diagonal_[i]);
    if (factor.info() != Eigen::Success)
      throw MachineError("the sag of a strand in air cannot be computed: its equations are singular");
    if (i < last) {
      const Mat6 below = below_[i];
      below_[i] = factor.solve(below.transpose()).transpose();
      diagonal_[i + 1] -= below_[i] * below.transpose();
      right_[i + 1] -= below_[i] * right_[i];
    }
    right_[i] = factor.solve(right_[i]).eval();
  }
  for (std::size_t i = last; i-- > 0;) right_[i] -= below_[i].transpose() * right_[i + 1];
}

/// Those at the front that crept no more in this step have the factors that they will have in every later
/// one.
void StrandFrame::settle(std::span<const double> creep) {
  const std::size_t before = settled_;
  while (settled_ + 1 < elements_.size() && creep[settled_] == 0) ++settled_;
  if (settled_ == before) return;
  const Element& e = elements_[settled_ - 1];
  const Matrix12 k = e.stiffness + e.torsion_stiffness;
  settled_stiffness_ = k.bottomRightCorner<6, 6>() - below_[settled_ - 1] * k.topRightCorner<6, 6>();
  settled_force_ = (e.load - e.force - e.torsion_force).tail<6>();
}

void StrandFrame::step(std::span<const double> creep) {
  assemble(creep);
  solve();
  Vector12 change;
  for (std::size_t i = settled_; i < elements_.size(); ++i) {
    Element& e = elements_[i];
    change << right_[i], right_[i + 1];
    e.force += e.keep * (e.stiffness * change);
    e.torsion_force += e.torsion_keep * (e.torsion_stiffness * change);
  }
  settled_force_ -= settled_stiffness_ * right_[settled_];
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].moved += right_[i].head<3>();
    nodes_[i].turned += right_[i].tail<3>();
  }
  settle(creep);
}

}  // namespace understudy::sim
