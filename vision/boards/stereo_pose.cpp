#include "vision/boards/stereo_pose.h"

#include <string>

#include "core/error.h"
#include "vision/boards/rigid_fit.h"

namespace understudy::vision {
namespace {

Approach approach(const StereoModel& model, const Vec2& first, const Vec2& second, int replica) {
  return closest_approach(model.cameras[0]->view_ray(first, replica),
                          model.cameras[1]->view_ray(second, replica));
}

/// Effect of the calibration's uncertainty on the three points together, replica by replica.
std::vector<Vec9> replica_shifts(const StereoModel& model,
                                 const std::array<std::array<PixelPoint, 3>, 2>& seen) {
  const int replicas = std::min(model.cameras[0]->replicas(), model.cameras[1]->replicas());
  const auto points = [&](int replica) {
    Vec9 p;
    for (std::size_t k = 0; k < 3; ++k) {
      p.segment<3>(3 * static_cast<Eigen::Index>(k)) =
          approach(model, seen[0][k].pixel, seen[1][k].pixel, replica).point;
    }
    return p;
  };
  const Vec9 as_calibrated = points(ViewRayModel::kAsCalibrated);
  std::vector<Vec9> shifts;
  for (int r = 0; r < replicas; ++r) shifts.push_back(points(r) - as_calibrated);
  return shifts;
}

}  // namespace

const char* to_string(PoseStatus s) {
  switch (s) {
    case PoseStatus::ok:
      return "ok";
    case PoseStatus::target_not_measured:
      return "a target could not be measured";
    case PoseStatus::view_rays_do_not_meet:
      return "the two view rays of a target do not meet";
    case PoseStatus::wrong_shape:
      return "the targets do not form their triangle";
    case PoseStatus::targets_in_line:
      return "the targets lie in one line";
  }
  return "unknown";
}

StereoModel calibrate_stereo(ViewRayMethod method, const std::array<CameraLayers, 2>& layers,
                             const CalibrationUncertainty& uncertainty) {
  StereoModel model;
  for (std::size_t i = 0; i < 2; ++i) {
    CalibrationUncertainty own = uncertainty;
    own.seed = hash_bits(uncertainty.seed, i);
    try {
      model.cameras[i] = calibrate_view_rays(method, layers[i], own);
    } catch (const InputError& e) {
      throw InputError("camera " + std::to_string(i) + ": " + e.what());
    }
  }
  return model;
}

LocatedPoint locate(const StereoModel& model, const std::array<PixelPoint, 2>& seen) {
  LocatedPoint located{approach(model, seen[0].pixel, seen[1].pixel, ViewRayModel::kAsCalibrated),
                       Mat3::Zero()};
  constexpr double kStep = 0.25;  // [px]: far above rounding, far below the cells of a layer
  for (std::size_t camera = 0; camera < 2; ++camera) {
    Eigen::Matrix<double, 3, 2> J;
    for (int axis = 0; axis < 2; ++axis) {
      std::array<Vec2, 2> up{seen[0].pixel, seen[1].pixel}, down = up;
      up[camera][axis] += kStep;
      down[camera][axis] -= kStep;
      J.col(axis) = (approach(model, up[0], up[1], ViewRayModel::kAsCalibrated).point -
                     approach(model, down[0], down[1], ViewRayModel::kAsCalibrated).point) /
                    (2 * kStep);
    }
    located.covariance += J * seen[camera].covariance * J.transpose();
  }
  return located;
}

PoseMeasurement measure_pose(const StereoModel& model, const std::array<Vec3, 3>& targets_T,
                             const std::array<std::array<PixelPoint, 3>, 2>& seen,
                             const PoseOptions& options) {
  PoseMeasurement m;
  std::array<Vec3, 3> p_W;
  Mat9 detection = Mat9::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const LocatedPoint point = locate(model, {seen[0][k], seen[1][k]});
    p_W[k] = point.place.point;
    const auto at = 3 * static_cast<Eigen::Index>(k);
    detection.block<3, 3>(at, at) = point.covariance;
    m.gap = std::max(m.gap, point.place.gap);
    m.beyond = std::max(m.beyond, point.place.beyond);
    if (!(point.place.gap <= options.gap_max)) {
      m.status = PoseStatus::view_rays_do_not_meet;
      m.target = static_cast<int>(k);
      return m;
    }
  }
  const auto fit = fit_rigid(targets_T, p_W);
  if (!fit) {
    m.status = PoseStatus::targets_in_line;
    return m;
  }
  m.X_WT = fit->X_WT;
  m.shape_rms = fit->residual_rms;
  m.status = m.shape_rms <= options.shape_max ? PoseStatus::ok : PoseStatus::wrong_shape;
  m.covariance = fit_covariance(m.X_WT, targets_T, detection);
  const auto response = fit_response(m.X_WT, targets_T);
  for (const Vec9& shift : replica_shifts(model, seen)) m.replicas.push_back(response * shift);
  for (const Twist& shift : m.replicas)  // of mean zero, to the first order
    m.systematic += shift * shift.transpose() / static_cast<double>(m.replicas.size());
  return m;
}

PoseMeasurement measure_pose(const StereoModel& model, const std::array<Vec3, 3>& targets_T,
                             const std::array<TargetsMeasurement, 2>& seen, const PoseOptions& options) {
  std::array<std::array<PixelPoint, 3>, 2> pixels;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    for (std::size_t k = 0; k < 3; ++k) {
      const TargetMeasurement& target = seen[camera].targets[k];
      if (target.status != TargetStatus::ok) {
        PoseMeasurement m;
        m.camera = static_cast<int>(camera);
        m.target = static_cast<int>(k);
        m.target_status = target.status;
        return m;
      }
      pixels[camera][k] = {target.centre_px, target.covariance_px2};
    }
  }
  return measure_pose(model, targets_T, pixels, options);
}

}  // namespace understudy::vision
