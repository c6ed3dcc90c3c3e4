// What some ports can tell besides MachinePort: where the axes are behind their plays.
#pragma once

#include "machine/port.h"

namespace understudy::machine {

/// By encoders of their own beside the drives': strut scales, rings at joints.
struct LoadReading {
  double sampled_at = 0;  ///< [s], port clock
  AxisVector position{};  ///< [m or rad], by the controller's geometry, as in AxisState
};

/// A port whose machine may have such encoders is one of these too. No controller steers by them; a record
/// holds them (docs/port-record.md).
class LoadSide {
 public:
  virtual ~LoadSide() = default;
  /// False where the machine has none: `reading` is left as it is. As AxisState, at rest and in motion.
  virtual bool read_load(LoadReading& reading) const = 0;
};

/// Of any port: false where it is no LoadSide.
inline bool read_load(const MachinePort& port, LoadReading& reading) {
  const auto* side = dynamic_cast<const LoadSide*>(&port);
  return side != nullptr && side->read_load(reading);
}

}  // namespace understudy::machine
