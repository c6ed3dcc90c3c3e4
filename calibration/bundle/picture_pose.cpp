#include "calibration/bundle/picture_pose.h"

#include <Eigen/Cholesky>

#include "calibration/bundle/session_time.h"
#include "core/cross_matrix.h"
#include "vision/boards/pixel_slopes.h"

namespace understudy::calibration {
namespace {

constexpr int kSteps = 6;  // of Gauss-Newton, from where all pictures together have the pose

}  // namespace

bool picture_pose(const BundleProblem& problem, const BundleState& state, std::size_t pose,
                  PoseSample& sample) {
  sample = strut_sample(problem, state, pose);
  sample.X_BT = state.poses[pose];
  vision::PixelSlopes at;
  for (int step = 0; step < kSteps; ++step) {
    Mat6 H = Mat6::Zero();
    Twist g = Twist::Zero();
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t k = 0; k < problem.rig.targets.size(); ++k) {
        const Vec3 arm = sample.X_BT.linear() * problem.rig.targets[k];
        const Vec3 p_W = problem.X_WB * (sample.X_BT.translation() + arm);
        if (!vision::pixel_slopes(state.cameras[c], p_W, at)) return false;
        Eigen::Matrix<double, 3, 6> motion;
        motion << Mat3::Identity(), -cross_matrix(arm);
        const Eigen::Matrix<double, 2, 6> J = at.by_point * problem.X_WB.linear() * motion;
        const vision::PixelPoint& seen = problem.poses[pose].targets[c][k];
        const Eigen::LLT<Eigen::Matrix2d> weight(seen.covariance);
        H += J.transpose() * weight.solve(J);
        g += J.transpose() * weight.solve(Vec2(at.pixel - seen.pixel));
      }
    const Eigen::LDLT<Mat6> factors(H);
    const Twist by = factors.solve(-g);
    if (!by.allFinite()) return false;
    sample.X_BT = make_pose(Mat3(exp_rotation(by.tail<3>()) * sample.X_BT.linear()),
                            Vec3(sample.X_BT.translation() + by.head<3>()));
    sample.covariance = factors.solve(Mat6::Identity());
  }
  sample.covariance = 0.5 * (sample.covariance + sample.covariance.transpose()).eval();
  return true;
}

}  // namespace understudy::calibration
