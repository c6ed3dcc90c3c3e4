#include "sim/plant/bullet/bullet_solver.h"

#include <Eigen/Cholesky>
#include <limits>

namespace understudy::sim {
namespace {

using Eigen::Index;

// A stop that misses its speed by less, or an impulse that pulls by less, is rounding.
constexpr double kSpeedTolerance = 1e-10;    // [m/s]
constexpr double kImpulseTolerance = 1e-12;  // [N s]
// Both stops of one play are one row twice: this keeps the matrix regular when both are tried.
constexpr double kRegularisation = 1e-12;
// Sets in which as many rows as before are misplaced, before going on row by row.
constexpr int kPatience = 10;

}  // namespace

double BulletSolver::coupling(const btMultiBodySolverConstraint& row,
                              const btMultiBodySolverConstraint& other) const {
  struct Part {
    const btMultiBody* body;
    int index;
  };
  const Part mine[] = {{row.m_multiBodyA, row.m_jacAindex}, {row.m_multiBodyB, row.m_jacBindex}};
  const Part theirs[] = {{other.m_multiBodyA, other.m_jacAindex}, {other.m_multiBodyB, other.m_jacBindex}};
  double sum = 0;
  for (const Part& a : mine) {
    for (const Part& b : theirs) {
      if (a.body == nullptr || a.body != b.body) continue;
      for (int i = 0; i < a.body->getNumDofs() + 6; ++i)
        sum += m_data.m_jacobians[a.index + i] * m_data.m_deltaVelocitiesUnitImpulse[b.index + i];
    }
  }
  return sum;
}

void BulletSolver::read_rows() {
  const auto& rows = m_multiBodyNonContactConstraints;
  const Index n = rows.size();
  A_.resize(n, n);
  for (Eigen::VectorXd* v : {&b_, &lower_, &upper_, &x_, &w_}) v->resize(n);
  for (Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<int>(i)];
    for (Index j = 0; j < i; ++j) A_(i, j) = A_(j, i) = coupling(row, rows[static_cast<int>(j)]);
    A_(i, i) = (1 + kRegularisation) / row.m_jacDiagABInv;  // with the softness of a damper
    b_(i) = row.m_rhs / row.m_jacDiagABInv;
    lower_(i) = row.m_lowerLimit;
    upper_(i) = row.m_upperLimit;
  }
  if (places_.size() == static_cast<std::size_t>(n)) return;
  places_.assign(static_cast<std::size_t>(n), Place::between);
  for (Index i = 0; i < n; ++i)
    if (lower_(i) == 0) places_[i] = Place::lower;
}

/// Impulses of the rows between their limits, the others being at theirs; w of all.
void BulletSolver::solve_between() {
  between_.clear();
  for (Index i = 0; i < x_.size(); ++i) {
    const Place place = places_[i];
    if (place == Place::between) between_.push_back(i);
    x_(i) = place == Place::lower ? lower_(i) : place == Place::upper ? upper_(i) : 0.0;
  }
  const Eigen::VectorXd all = b_ - A_ * x_, rest = all(between_);
  const Eigen::MatrixXd square = A_(between_, between_);
  const Eigen::VectorXd impulses = square.ldlt().solve(rest);
  x_(between_) = impulses;
  w_ = A_ * x_ - b_;
}

/// Moves rows that are on the wrong side of a limit, all or the last; their number.
int BulletSolver::misplaced(bool only_last) {
  int count = 0;
  for (Index i = x_.size() - 1; i >= 0; --i) {
    Place& place = places_[i];
    Place better = place;
    if (place == Place::between) {
      if (x_(i) < lower_(i) - kImpulseTolerance) better = Place::lower;
      if (x_(i) > upper_(i) + kImpulseTolerance) better = Place::upper;
    } else if (place == Place::lower ? w_(i) < -kSpeedTolerance : w_(i) > kSpeedTolerance) {
      better = Place::between;
    }
    if (better == place) continue;
    if (!only_last || count == 0) place = better;
    ++count;
  }
  return count;
}

bool BulletSolver::solve() {
  int fewest = std::numeric_limits<int>::max(), patience = kPatience;
  for (int pivot = 0; pivot < most_pivots_; ++pivot) {
    solve_between();
    if (!w_.allFinite()) return false;
    // Murty's rule, which always ends, once blocks of rows no longer do.
    const int count = misplaced(patience == 0);
    if (count == 0) return true;
    if (count < fewest) {
      fewest = count;
      patience = kPatience;
    } else if (patience > 0) {
      --patience;
    }
  }
  return false;
}

void BulletSolver::apply() {
  for (Index i = 0; i < x_.size(); ++i) {
    const auto& row = m_multiBodyNonContactConstraints[static_cast<int>(i)];
    row.m_appliedImpulse = x_(i);
    if (row.m_multiBodyA != nullptr)
      row.m_multiBodyA->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex], x_(i));
    if (row.m_multiBodyB != nullptr)
      row.m_multiBodyB->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacBindex], x_(i));
  }
}

btScalar BulletSolver::solveGroupCacheFriendlyIterations(btCollisionObject**, int, btPersistentManifold**,
                                                         int, btTypedConstraint**, int,
                                                         const btContactSolverInfo&, btIDebugDraw*) {
  read_rows();
  solved_ = solve();
  if (solved_) apply();
  return 0;
}

}  // namespace understudy::sim
