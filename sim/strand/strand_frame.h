// A chain of Maxwell beam elements in space (bending, torsion, stretching), growing at one end: the mechanics
// of a strand drawn through air along a curve. Linear: displacements are small compared with the curve's
// radii.
#pragma once

#include <span>
#include <vector>

#include "core/frames.h"

namespace understudy::sim {

class StrandFrame {
 public:
  struct Section {
    double diameter;        ///< [m], round
    double youngs_modulus;  ///< [Pa]
    double shear_modulus;   ///< [Pa]
    Vec3 load_W;            ///< [N/m]
  };

  /// The first node is clamped.
  StrandFrame(const Section& section, const Vec3& start_W);

  std::size_t elements() const { return elements_.size(); }

  /// A new element, without stress, from the programmed place of the present end (wherever it moved since) to
  /// `to_W`, whose node does not move while the end is held.
  void append(const Vec3& to_W);
  void hold_end(bool held) { end_held_ = held; }
  /// From now on this node does not move, but turns.
  void support(std::size_t node) { nodes_[node].supported = true; }

  /// Moves on by `creep[i]` = integral of 1/(3 eta) over the time of the step [1/Pa], for each element.
  /// Elements at the front whose creep is 0 are solid from then on: they creep no more, whatever a later step
  /// says. Throws MachineError when the equations have no solution.
  void step(std::span<const double> creep);

  const Vec3& displacement_W(std::size_t node) const { return nodes_[node].moved; }  ///< [m]
  const Vec3& rotation_W(std::size_t node) const { return nodes_[node].turned; }     ///< [rad]

 private:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  using Vector12 = Eigen::Matrix<double, 12, 1>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  struct Node {
    Vec3 programmed;
    Vec3 moved{0, 0, 0}, turned{0, 0, 0};
    bool supported = false;
  };
  /// Torsion relaxes at another rate than bending and stretching, so its stiffness and forces are apart. In
  /// W.
  struct Element {
    Matrix12 stiffness, torsion_stiffness;
    Vector12 load;
    Vector12 force = Vector12::Zero(), torsion_force = Vector12::Zero();
    double keep = 1, torsion_keep = 1;  ///< of the forces, over a step without motion
  };

  Element make_element(const Vec3& along) const;
  void assemble(std::span<const double> creep);
  void fix(std::size_t node, int components);
  void solve();
  void settle(std::span<const double> creep);

  Section section_;
  bool end_held_ = true;
  std::vector<Node> nodes_;
  std::vector<Element> elements_;

  // The first elements that are solid keep their stiffness for ever, and their nodes their equilibrium: they
  // are eliminated once, and a step costs what is behind them.
  std::size_t settled_ = 0;
  Mat6 settled_stiffness_ = Mat6::Zero();  ///< of all of them, at the node that ends them
  Vector6 settled_force_ = Vector6::Zero();

  // The block-tridiagonal equations of a step: after solve(), the factor below the diagonal and the motion.
  std::vector<Mat6> diagonal_, below_;
  std::vector<Vector6> right_;
};

}  // namespace understudy::sim
