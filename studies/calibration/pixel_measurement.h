// Poses of a machine measured from rendered pictures: boards at their layers calibrate two cameras, then the
// three targets on the platform are photographed pose by pose (Song 2015, section 4 and appendix B).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/machine/camera_poses.h"
#include "calibration/problem.h"
#include "core/random.h"
#include "machine/description.h"
#include "renderer/calibration_view.h"
#include "studies/calibration/rig_scenes.h"
#include "vision/boards/rig_file.h"
#include "vision/boards/rig_measurement.h"

namespace understudy::studies {

/// Takes whole pictures under the names that the rig gives them.
using PictureSink = std::function<void(const std::string& name, const Image& picture)>;

struct StandOptions {
  vision::ViewRayMethod method = vision::ViewRayMethod::pinhole;
  vision::BoardTolerance boards{20e-6, 0.2e-3, 0};  ///< how well the boards are placed
  int layers = 11;                                  ///< of each camera, over 50 mm of depth; 2 or more
  std::uint64_t seed = 1;                           ///< of cameras, boards and sensors
  PictureSink keep{};  ///< optional; of boards from the threads that photograph them, of poses whole pictures
};

/// What is believed of the stand before a machine, before its cameras are calibrated: the designed rig, how
/// well it is known, and the names of its pictures. InputError for a chain, or fewer than two layers.
vision::RigDescription designed_stand(const machine::MachineDescription& machine,
                                      const StandOptions& options);

/// Two cameras, calibrated from pictures of boards, as they stand before a hexapod. What is measured uses the
/// designed set-up only; the built one differs from it by what `seed` says (sample_built_rig). Target 0 is
/// the tip: the targets' frame is T, and the triangle's own shape is known.
class MeasuringStand {
 public:
  /// Photographs all boards (two for each layer, 0.4 s of one core a picture) and calibrates the cameras.
  /// `progress` gets 0..1.
  MeasuringStand(const machine::MachineDescription& machine, const StandOptions& options, int threads,
                 const std::function<void(double)>& progress = {});

  /// Reachable poses X_BT at which both cameras see all targets whole, even where the machine misses by 8 mm.
  std::vector<Pose> poses_in_view(const kinematics::Mechanism& mechanism, std::size_t count,
                                  Random& random) const;

  /// Photographs the targets where they are and measures them; `X_WT_expected` tells which is which. `number`
  /// numbers the poses: the same number gives the same noise.
  calibration::CameraPose measure(renderer::CalibrationView& view, const Pose& X_WT_true,
                                  const Pose& X_WT_expected, std::uint64_t number) const;

  /// Its pictures, measured: of camera 0 and 1.
  std::array<vision::TargetsMeasurement, 2> see(renderer::CalibrationView& view, const Pose& X_WT_true,
                                                const Pose& X_WT_expected, std::uint64_t number) const;
  /// The pose that these pictures show.
  calibration::CameraPose pose_of(const std::array<vision::TargetsMeasurement, 2>& seen) const;

  /// All boards as they were measured.
  const std::vector<vision::SeenBoard>& boards() const { return boards_; }
  const vision::RigDescription& description() const { return description_; }
  const vision::CalibrationRig& designed() const { return description_.rig; }
  const BuiltRig& built() const { return built_; }
  const StandOptions& options() const { return options_; }

 private:
  StandOptions options_;
  Pose X_WB_, X_BT_home_;
  vision::RigDescription description_;
  BuiltRig built_;
  std::vector<vision::SeenBoard> boards_;
  vision::StereoModel model_;
};

}  // namespace understudy::studies
