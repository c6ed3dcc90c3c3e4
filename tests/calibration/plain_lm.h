// A plain Levenberg-Marquardt with numerical derivatives: slow, obvious, and nothing of ours in it.
#pragma once

#include <algorithm>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace understudy::calibration {

/// Least squares of f over x, from x; numbers that f does not tell stay near where they began.
inline Eigen::VectorXd plain_lm(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
                                Eigen::VectorXd x, int steps) {
  double damping = 1e-3;
  Eigen::VectorXd e = f(x);
  for (int step = 0; step < steps; ++step) {
    Eigen::MatrixXd J(e.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd up = x, down = x;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      J.col(k) = (f(up) - f(down)) / 2e-6;
    }
    const Eigen::MatrixXd H = J.transpose() * J;
    for (int attempt = 0; attempt < 30; ++attempt) {
      Eigen::MatrixXd damped = H;
      damped.diagonal() += damping * H.diagonal();
      damped.diagonal().array() += 1e-12 * H.diagonal().maxCoeff();
      const Eigen::VectorXd next = x - damped.ldlt().solve(J.transpose() * e);
      const Eigen::VectorXd after = f(next);
      if (after.squaredNorm() <= e.squaredNorm()) {
        x = next;
        e = after;
        damping = std::max(1e-15, damping / 10);
        break;
      }
      damping *= 10;
    }
  }
  return x;
}

}  // namespace understudy::calibration
