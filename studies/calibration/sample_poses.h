// Where to drive a machine to have it calibrated, and what a twin would measure there.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "calibration/machine/measurement_table.h"
#include "machine/default_machine.h"
#include "studies/calibration/pixel_measurement.h"

namespace understudy::studies {

struct SamplePosesRequest {
  std::string machine = machine::kDefaultMachine;  ///< name or path
  int count = 24;
  std::string design = "d-optimal";     ///< or random
  int candidates = 300;                 ///< that d-optimal poses are chosen from
  std::optional<std::string> as_built;  ///< of a twin that is measured (sim::make_as_built); else none is
  /// Measure the twin with two rendered cameras (pixel_measurement.h) in place of drawn noise: a hexapod
  /// only.
  bool from_pixels = false;
  /// The plant that the twin is driven on (session_engines()); empty: poses by forward kinematics.
  std::string engine;
  /// [K] by which screws warm during the session, on a plant; of a hexapod.
  double warming = 0;
  vision::BoardTolerance boards{20e-6, 0.2e-3, 0};  ///< of the measuring set-up, from pixels
  /// Of the measured poses; also what d-optimal poses are chosen for.
  calibration::MeasurementNoise noise = calibration::kReferenceNoise;
  std::uint64_t seed = 1;
};

/// What a run from pixels knows beside its measurements.
struct PictureRecord {
  PictureSink keep;                     ///< set by the caller: gets all pictures
  vision::RigDescription rig;           ///< as it is believed to be; its file is not named
  BuiltRig built;                       ///< as it is
  calibration::Measurements commanded;  ///< a row for each pose that was photographed, from pose 1
  calibration::Measurements truth;      ///< likewise: where the tool was
};

/// Poses within the machine's limits with the axes that its model computes for them. Measured: where the
/// twin's geometry puts the tool then, without play; on a plant where the tool rests (plant_session.h), with
/// the sides on which a controller says that plays rest. Else the poses asked for, to be replaced by measured
/// ones. Throws InputError; MachineError where nothing can be rendered. `progress` gets
/// 0..1; `record` is filled from pixels only.
calibration::Measurements sample_poses(const SamplePosesRequest& request,
                                       const machine::MachineDescription& machine,
                                       const std::function<void(double)>& progress = {},
                                       PictureRecord* record = nullptr);

}  // namespace understudy::studies
