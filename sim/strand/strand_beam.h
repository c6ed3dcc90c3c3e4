// A Maxwell beam-string between two supports, growing at one end: the mechanics of a strand in air, without
// its temperature.
//
// Bending  kappa' = M'/(E I) + M phi/I,  stretching  e' = N'/(E A) + N phi/A,  phi = 1/(3 eta) the fluidity
// of stretching (3 eta: Trouton's ratio). Equilibrium across the chord  M'' - (N w')' = q,  along it  N' =
// -q_along; the length is  d/dt (integral of w'^2/2) = integral of e' + overfeed  (moderate slopes, shallow
// cable). Cubic beam elements in space; in time implicit, exact for a moment that is constant over the step.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace understudy::sim {

/// How an end of a strand is held.
enum class Hold { clamped, pinned, free };

class BeamString {
 public:
  struct Section {
    double element_length;      ///< [m]
    double area;                ///< [m^2]
    double second_moment;       ///< [m^4]
    double modulus;             ///< [Pa]
    double load_across;         ///< [N/m], in the direction of positive deflection
    double load_along;          ///< [N/m], from the first support to the end
    bool keeps_length = false;  ///< under compression it does not creep shorter and thicker, only bend
  };

  BeamString(const Section& section, Hold start, Hold end, std::size_t capacity);

  std::size_t elements() const { return elements_; }

  /// A new element, without stress, between the present end and a new end on the chord, with `slack` [m] more
  /// material than chord.
  void append(double slack);
  void hold_end(Hold end) { end_ = end; }

  /// Moves on by `creep[i]` = integral of 1/(3 eta) over the time of the step [1/Pa], for each element. A
  /// step in which the strand buckles is divided. False when it falls: no equilibrium is found, or it is off
  /// its chord by more than the chord's length, so that nothing of it means anything any more.
  [[nodiscard]] bool step(std::span<const double> creep);

  double deflection(std::size_t node) const { return w_[2 * node]; }
  double slope(std::size_t node) const { return w_[2 * node + 1]; }
  double tension() const { return tension_; }  ///< [N], at the first support
  /// [m]: by how much the strand is longer than its chord.
  double extra_length() const { return half_slope_square(w_); }

 private:
  using Row = std::array<double, 4>;  ///< diagonal and the three entries left of it

  bool try_step(std::span<const double> creep, double share, double slack);
  bool surplus(double tension, double length, double& value, double& derivative);
  void assemble(double tension);
  void slope_forces(const std::vector<double>& w, std::vector<double>& forces) const;
  void accept(double tension);
  bool factorise();
  void back_substitute(std::vector<double>& x) const;
  double tension_of(std::size_t element, double at_start) const;
  double half_slope_square(const std::vector<double>& w) const;
  bool fixed(std::size_t dof) const;

  Section section_;
  Hold start_, end_;
  std::size_t elements_ = 0;
  double tension_ = 0, slack_ = 0;
  std::vector<double> w_;                      ///< deflection and slope of each node
  std::vector<std::array<double, 2>> moment_;  ///< [N m], at the two Gauss points of each element
  std::vector<double> element_tension_;        ///< [N], at the end of the last step

  // Workspace of a step.
  std::vector<Row> matrix_;
  std::vector<double> next_, motion_, slope_forces_, by_tension_, relax_;
};

}  // namespace understudy::sim
