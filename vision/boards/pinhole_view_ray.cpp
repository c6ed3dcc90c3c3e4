#include <Eigen/Eigenvalues>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "core/error.h"
#include "vision/boards/board_adjustment.h"
#include "vision/boards/lens_distortion.h"
#include "vision/boards/view_ray_models.h"

namespace understudy::vision {
namespace {

constexpr double kWorstResidual = 20;  // [px]: boards misplaced by 1 mm give 10

class PinholeViewRays : public ViewRayModel {
 public:
  PinholeViewRays(const CameraLayers& layers, const CalibrationUncertainty& uncertainty);
  ViewRay view_ray(const Vec2& pixel, int replica) const override;
  int replicas() const override { return static_cast<int>(cameras_.size()) - 1; }
  double residual_px() const override { return residual_; }

 private:
  void add(const CameraParameters& v, const MountedCamera& designed);

  double near_ = 0, far_ = 0;           // [m], depths of the layers
  std::vector<MountedCamera> cameras_;  // as calibrated, then the replicas
  double residual_ = 0;
};

/// One view of all layers where they are meant to be: their known steps of depth determine the focal length.
CameraParameters calibrate_at_once(const CameraLayers& layers) {
  const Camera& designed = layers.camera.camera;
  const Pose X_FW = layers.camera.X_WC.inverse();
  std::vector<std::vector<cv::Point3f>> places(1);
  std::vector<std::vector<cv::Point2f>> pixels(1);
  for (const BoardLayer& layer : layers.layers) {
    for (int i = 0; i < layers.board.corners(); ++i) {
      const Vec3 p_G = layers.board.corner(i % layers.board.columns, i / layers.board.columns);
      const Eigen::Vector3f p = (X_FW * layer.X_WG * p_G).cast<float>();
      const Eigen::Vector2f px = layer.corners_px[static_cast<std::size_t>(i)].cast<float>();
      places[0].emplace_back(p.x(), p.y(), p.z());
      pixels[0].emplace_back(px.x(), px.y());
    }
  }
  cv::Mat matrix = (cv::Mat_<double>(3, 3) << designed.focal_px, 0, designed.centre_px.x(), 0,
                    designed.focal_px, designed.centre_px.y(), 0, 0, 1);
  cv::Mat brown = cv::Mat::zeros(5, 1, CV_64F);
  std::vector<cv::Mat> turns, shifts;
  double residual = 0;
  try {
    residual =
        cv::calibrateCamera(places, pixels, {designed.width, designed.height}, matrix, brown, turns, shifts,
                            cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_FIX_K3,
                            {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-9});
  } catch (const cv::Exception& e) {
    throw InputError("camera calibration: the pinhole cannot be fitted: " + e.err);
  }
  if (!(residual < kWorstResidual)) {
    throw InputError("camera calibration: corners are " + std::to_string(residual) +
                     " px RMS off the best pinhole, must be below " + std::to_string(kWorstResidual));
  }
  CameraParameters v;
  v << Vec3(turns[0].at<double>(0), turns[0].at<double>(1), turns[0].at<double>(2)),
      Vec3(shifts[0].at<double>(0), shifts[0].at<double>(1), shifts[0].at<double>(2)),
      matrix.at<double>(0, 0), matrix.at<double>(0, 2), matrix.at<double>(1, 2), brown.at<double>(0),
      brown.at<double>(1), brown.at<double>(2), brown.at<double>(3);
  return v;
}

void PinholeViewRays::add(const CameraParameters& v, const MountedCamera& designed) {
  MountedCamera m = designed;
  m.camera.focal_px = v[6];
  m.camera.centre_px = v.segment<2>(7);
  m.camera.k1 = v[9], m.camera.k2 = v[10], m.camera.p1 = v[11], m.camera.p2 = v[12];
  m.X_WC = designed.X_WC * make_pose(exp_rotation(v.head<3>()), v.segment<3>(3)).inverse();
  cameras_.push_back(m);
}

PinholeViewRays::PinholeViewRays(const CameraLayers& layers, const CalibrationUncertainty& uncertainty) {
  cv::setNumThreads(1);
  const Pose X_FW = layers.camera.X_WC.inverse();
  near_ = (X_FW * layers.layers.front().X_WG).translation().z();
  far_ = (X_FW * layers.layers.back().X_WG).translation().z();
  const BoardAdjustment adjusted = adjust_boards(layers, uncertainty, calibrate_at_once(layers));
  if (!adjusted.camera.allFinite() || !adjusted.covariance.allFinite()) {
    throw InputError(
        "camera calibration: the pinhole cannot be fitted to the boards within their tolerances");
  }
  residual_ = adjusted.residual_px;
  add(adjusted.camera, layers.camera);

  const CameraParameters scale = adjusted.covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const CameraCovariance correlation =
      scale.cwiseInverse().asDiagonal() * adjusted.covariance * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<CameraCovariance> axes(correlation);
  Random random(uncertainty.seed, "camera calibration replicas");
  for (int r = 0; r < uncertainty.replicas; ++r) {
    CameraParameters draw;
    for (int i = 0; i < kCameraParameters; ++i) {
      draw[i] = std::sqrt(std::max(0.0, axes.eigenvalues()[i])) * random.normal();
    }
    add(adjusted.camera + scale.cwiseProduct(axes.eigenvectors() * draw), layers.camera);
  }
}

ViewRay PinholeViewRays::view_ray(const Vec2& pixel, int replica) const {
  const MountedCamera& m = cameras_[static_cast<std::size_t>(replica + 1)];
  const Vec2 ray = ray_of_pixel(m.camera, pixel);
  const Vec3 direction(ray.x(), ray.y(), 1);
  return {{m.X_WC * Vec3(near_ * direction), m.X_WC * Vec3(far_ * direction)}};
}

}  // namespace

std::shared_ptr<const ViewRayModel> calibrate_pinhole(const CameraLayers& layers,
                                                      const CalibrationUncertainty& uncertainty) {
  return std::make_shared<PinholeViewRays>(layers, uncertainty);
}

}  // namespace understudy::vision
