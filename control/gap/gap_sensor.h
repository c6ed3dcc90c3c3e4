// One frame of the microscope: expose, measure, invert, and judge whether it can be believed.
#pragma once

#include <cstdint>
#include <optional>

#include "control/gap/gap_controller.h"

namespace understudy::control {

/// What the next reading should be, from the last one and the motion since.
struct Expectation {
  double gap = 0;    ///< [m]
  double bound = 0;  ///< [m], a reading farther off is implausible
};

class GapSensor {
 public:
  GapSensor(const machine::MachineDescription& machine, const LocalSurface& surface,
            const GapControllerOptions& options, machine::MachinePort& port);

  /// The tool stands: a frame that is lost or stale is asked for again, thrice in all. Without an expectation
  /// the whole sensor is read. The result says why `sample` cannot be used;
  /// none: it can.
  GapStop take(const std::optional<Expectation>& expected, GapSample& sample);

  /// One exposure of where the dot of such gaps is, without a second try on the whole sensor; it must be
  /// there within `patience` [s]. The dot is measured, not read.
  GapStop expose_around(const Expectation& expected, double patience, GapSample& sample);
  /// Reads the gap off the dot that was measured, on the surface as it is now.
  GapStop read(GapSample& sample) const;

 private:
  GapStop expose(const Region& region, double patience, GapSample& sample);
  GapStop expose_standing(const Region& region, GapSample& sample);
  Region region_around(const Expectation& expected) const;
  GapStop judge_dot(GapSample& sample) const;
  GapStop judge_reading(const std::optional<Expectation>& expected, GapSample& sample) const;

  const machine::MachineDescription& machine_;
  const LocalSurface& surface_;
  const GapControllerOptions& options_;
  machine::MachinePort& port_;
  vision::DotOptions dot_options_;
  std::optional<std::uint64_t> last_number_;
};

/// How the dot of this laser looks in this microscope.
vision::DotOptions dot_options(const machine::MachineDescription& machine);

}  // namespace understudy::control
