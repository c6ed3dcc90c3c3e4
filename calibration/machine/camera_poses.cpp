#include "calibration/machine/camera_poses.h"

#include <fmt/format.h>

namespace understudy::calibration {
namespace {

std::string reason(const vision::PoseMeasurement& m) {
  if (m.status == vision::PoseStatus::target_not_measured)
    return fmt::format("camera {}, target {}: {}", m.camera, m.target, to_string(m.target_status));
  return m.target >= 0 ? fmt::format("target {}: {}", m.target, to_string(m.status)) : to_string(m.status);
}

}  // namespace

CameraPose camera_pose(const vision::PoseMeasurement& measured) {
  CameraPose pose;
  if (measured.status != vision::PoseStatus::ok) {
    pose.failure = reason(measured);
    return pose;
  }
  pose.X_WT = measured.X_WT;
  pose.covariance = measured.total();
  pose.detection = measured.covariance;
  pose.shared = measured.replicas;
  pose.beyond = measured.beyond;
  return pose;
}

MeasuringFrame take_out_frame(std::vector<CameraPose>& poses) {
  std::vector<SharedError> shared;
  for (const CameraPose& pose : poses)
    if (pose.ok()) shared.push_back({pose.X_WT.translation(), pose.shared, Mat6::Zero()});
  const MeasuringFrame frame = measuring_frame(shared);
  std::size_t next = 0;
  for (CameraPose& pose : poses)
    if (pose.ok()) pose.covariance = pose.detection + shared[next++].left;
  return frame;
}

Measurements measured_table(const Measurements& commanded, std::vector<CameraPose> poses) {
  Measurements table = commanded;
  table.poses.clear();
  table.noise_given = true;
  table.frame = take_out_frame(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].ok()) continue;
    table.poses.push_back(commanded.poses[i]);
    table.poses.back().X_WT = poses[i].X_WT;
    table.poses.back().covariance = poses[i].covariance;
  }
  return table;
}

}  // namespace understudy::calibration
