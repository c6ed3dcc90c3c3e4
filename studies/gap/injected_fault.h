// What is made to go wrong in a trial on the whole twin, and which stops answer it rightly.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/gap/gap_stop.h"
#include "core/random.h"
#include "machine/description.h"
#include "sim/faults/camera_faults.h"
#include "sim/faults/faults.h"

namespace understudy::studies {

struct FaultType {
  const char* name;                            ///< a word of tables
  std::optional<sim::CameraFaultKind> camera;  ///< of the picture,
  std::optional<sim::FaultKind> machine;       ///< or of the machine; neither: nothing goes wrong
  std::vector<control::GapStop> right;         ///< reasons of a stop that name what there is to see of it
  const char* why;                             ///< these are right
};

/// Nothing first, then faults of the picture, then those of the machine.
const std::vector<FaultType>& fault_types();

struct InjectedFault {
  std::vector<sim::CameraFaultEvent> camera;
  std::vector<sim::FaultEvent> machine;
  double time = 0;  ///< [s], port clock
  std::string words;
};

/// Where a trial's fault may strike.
struct FaultWindow {
  double begin = 0, end = 0;  ///< [s], port clock
  Pose X_WT_S = Pose::Identity();
};

/// Farther than this a fault of the machine does not move the nozzle at once, along the tool axis: half of
/// what lies between the aim and the part is left, whatever a controller does.
constexpr double kMachineJump = 65e-6;  // [m]

/// Time, share of the frames, axis and size are drawn. Half of the camera's faults are in every frame from
/// then on, the others in a share of them.
InjectedFault draw_fault(const FaultType& type, const FaultWindow& window,
                         const machine::MachineDescription& machine, Random& random);

}  // namespace understudy::studies
