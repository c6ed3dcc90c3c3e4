// Normal equations of unknowns that all equations share and of local ones, block by block, that no equation
// couples: H = [S C; C^T L] with L block diagonal. Solved by the Schur complement S - C L^-1 C^T (Triggs
// 2000, section 6.1), whose inverse is the covariance of the shared unknowns.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace understudy::calibration {

class ArrowEquations {
 public:
  ArrowEquations(Eigen::Index shared, std::span<const Eigen::Index> local_sizes);

  /// Equations 0 = residual + J step, each of variance 1. `columns`: the shared unknowns that the columns of
  /// `by_shared` belong to. `block` is the local one.
  void add(const Eigen::VectorXd& residual, std::span<const Eigen::Index> columns,
           const Eigen::MatrixXd& by_shared, std::size_t block, const Eigen::MatrixXd& by_local);
  /// One equation of one unknown: what was known before.
  void add_prior(Eigen::Index shared, double residual, double weight);
  void add_local_prior(std::size_t block, Eigen::Index row, double residual, double weight);

  double cost() const { return cost_; }  ///< sum of squares of the residuals
  long equations() const { return equations_; }
  long unknowns() const;

  struct Step {
    Eigen::VectorXd shared;
    std::vector<Eigen::VectorXd> local;
    double curvature = 0;  ///< step^T H step
  };
  /// (H + damping diag H) step = -gradient; false where that has no solution.
  bool solve(double damping, Step& step) const;
  /// Covariance of the shared unknowns; false where H is not positive definite.
  bool covariance(Eigen::MatrixXd& shared) const;

 private:
  struct Block {
    Eigen::MatrixXd H, C;  ///< own, and shared rows over own columns
    Eigen::VectorXd g;
  };
  Eigen::MatrixXd S_;
  Eigen::VectorXd g_;
  std::vector<Block> blocks_;
  double cost_ = 0;
  long equations_ = 0;
};

}  // namespace understudy::calibration
