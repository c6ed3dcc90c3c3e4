// Poses of a machine measured from rendered pictures: boards at their layers calibrate two cameras, then the
// three targets on the platform are photographed pose by pose (Song 2015, section 4 and appendix B).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "calibration/machine/measuring_frame.h"
#include "calibration/problem.h"
#include "core/random.h"
#include "machine/description.h"
#include "renderer/calibration_view.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::studies {

struct StandOptions {
  vision::SightMethod method = vision::SightMethod::pinhole;
  BoardTolerance boards{20e-6, 0.2e-3, 0};  ///< how well the boards are placed
  int layers = 11;                          ///< of each camera, over 50 mm of depth; 2 or more
  std::uint64_t seed = 1;                   ///< of cameras, boards and sensors
};

/// One pose from two pictures.
struct PixelPose {
  std::string failure;             ///< one line; empty when measured
  Pose X_BT = Pose::Identity();    ///< measured
  Mat6 covariance = Mat6::Zero();  ///< as PoseSample::covariance; the cameras' share included
  Mat6 detection = Mat6::Zero();   ///< of it what changes from picture to picture
  std::vector<Twist> shared;       ///< in B: the cameras' share, as SharedError::shifts
  double beyond = 0;               ///< [m], a target's farthest distance outside of the layers
  bool ok() const { return failure.empty(); }
};

/// Takes what all poses share out of their covariances: the frame is left, and told. Poses that failed stay
/// as they are.
calibration::MeasuringFrame take_out_frame(std::vector<PixelPose>& poses);

/// Two cameras, calibrated from pictures of boards, as they stand before a hexapod. What is measured uses the
/// designed set-up only; lenses (2 to 8 px of distortion at the picture's edge), focal lengths (0.3 %), and
/// mounts (0.3 mm, 2 mrad) are off by what `seed` says. Target 0 is the tip: the targets' frame is T, and the
/// triangle's own shape is known.
class MeasuringStand {
 public:
  /// Photographs all boards (two for each layer, 0.4 s of one core a picture) and calibrates the cameras.
  /// `progress` gets 0..1.
  MeasuringStand(const machine::MachineDescription& machine, const StandOptions& options, int threads,
                 const std::function<void(double)>& progress = {});

  /// Reachable poses at which both cameras see all targets whole, even where the machine misses by 8 mm.
  std::vector<Pose> poses_in_view(const kinematics::Mechanism& mechanism, std::size_t count,
                                  Random& random) const;

  /// Photographs the targets where they are and measures them; `X_BT_expected` tells which is which. `frame`
  /// numbers the pictures: the same number gives the same noise.
  PixelPose measure(renderer::CalibrationView& view, const Pose& X_BT_true, const Pose& X_BT_expected,
                    std::uint64_t frame) const;

  const CalibrationRig& designed() const { return designed_; }
  const CalibrationRig& built() const { return built_; }
  const StandOptions& options() const { return options_; }

 private:
  std::array<Vec2, 3> targets_px(int camera, const Pose& X_WT) const;
  bool in_view(const Pose& X_BT) const;

  StandOptions options_;
  Pose X_WB_, X_BT_home_;
  CalibrationRig designed_, built_;
  vision::StereoModel model_;
};

}  // namespace understudy::studies
