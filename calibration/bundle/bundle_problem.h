// Bundle adjustment: what was measured in pixels, what is unknown, and how well it was known before (Triggs
// 2000; Song 2015, section 4 and appendix B). Everything is SI, pictures are in px.
//
// Unknown are both cameras (13 numbers each), the placement of every board and the print of each camera's
// board, the pose of the tool in every picture, and the machine (calibration/problem.h) with its drives.
//
// Frame W is where the boards say that it is: nothing else measures it. A rigid motion of W by which all
// boards err together is in no residual, and averages over the boards alone (docs/calibration-data.md).
#pragma once

#include <array>
#include <vector>

#include "calibration/problem.h"
#include "vision/boards/rig_measurement.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::calibration {

/// The pictures of one pose, held still.
struct BundlePose {
  int number = 0;               ///< as its pictures are named
  StrutLengths displacement{};  ///< [m], of the drives: commanded strut length less the nominal l_i0
  /// The side on which the play of each strut rested.
  kinematics::PerStrut<Approach> approach{};
  double time = 0;               ///< [s], of any clock; of warming only
  Pose X_BT = Pose::Identity();  ///< where the controller believed the tool to be: start of the search
  std::array<std::array<vision::PixelPoint, 3>, 2> targets;  ///< of each camera
};

/// What is known of the machine's drives before any picture: standard deviations.
struct DriveTolerance {
  /// [m], of one commanded length, from pose to pose: microsteps and the error within a turn of the screw.
  double length = 1e-6;
  double lead = 0;          ///< relative, of each screw; 0: exact
  double play = 0;          ///< [m], of each play about its nominal one, where it is unknown; 0: not known
  double side_unknown = 0;  ///< [m], of a length in addition, where the side of the play is not known
  double warming = 0;       ///< [m], growth of all struts during the session; 0: none
};

struct BundleProblem {
  vision::CalibrationRig rig;                  ///< as designed
  vision::CalibrationUncertainty uncertainty;  ///< boards, corner_px and principal_px
  std::vector<vision::SeenBoard> boards;
  Pose X_WB = Pose::Identity();
  HexapodParameters nominal;
  DriveTolerance drives;
  Unknowns unknowns;
  std::vector<BundlePose> poses;

  bool leads_unknown() const { return drives.lead > 0; }
  bool warms() const { return drives.warming > 0; }
};

constexpr int kWarmingTerms = 3;

/// Values of all unknowns.
struct BundleState {
  std::array<vision::MountedCamera, 2> cameras;
  std::array<vision::PrintError, 2> prints;    ///< of the board before each camera
  std::vector<vision::BoardPlacement> boards;  ///< of problem.boards
  HexapodParameters machine;
  kinematics::PerStrut<double> lead{};  ///< relative: a strut moves by (1 + lead) its drive's displacement
  /// [m]: at time t struts are shorter than at the last pose by w_0 u + w_1 u^2 + w_2 u^3, u the time left
  /// until then over that of the session.
  Vec3 warming{0, 0, 0};
  std::vector<Pose> poses;  ///< X_BT of problem.poses
};

/// As designed, and as the controller believes.
BundleState start_of(const BundleProblem& problem);

/// Strut lengths that this machine makes of a pose's commands.
StrutLengths strut_lengths(const BundleProblem& problem, const BundleState& state, std::size_t pose);

}  // namespace understudy::calibration
