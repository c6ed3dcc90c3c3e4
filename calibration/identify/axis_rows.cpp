#include "calibration/identify/axis_rows.h"

#include <algorithm>
#include <cmath>

#include "machine/record/commanded_path.h"

namespace understudy::calibration {
namespace {

using machine::LoadReading;

std::vector<std::vector<AxisRow>> rows_of(const std::vector<LoadReading>& readings,
                                          const machine::RecordedMotion& motion,
                                          const machine::MachineDescription& machine,
                                          const machine::LoadEncoderCounts& counts) {
  machine::CommandedPath path(motion, machine);
  const kinematics::AxisVector zero = machine.drive_zero();
  const auto mechanism = machine.make_mechanism();
  std::vector<std::vector<AxisRow>> rows(static_cast<std::size_t>(motion.axes));
  for (const LoadReading& reading : readings) {
    const auto& target = path.at(reading.sampled_at);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const machine::Drive& drive = machine.drives[i];
      const AxisRow row{reading.sampled_at - motion.begins, target.position[i] - zero[i], target.velocity[i],
                        reading.position[i] - zero[i]};
      const double apart =
          0.5 * std::max(drive.step(), counts.of(mechanism->axis_is_angle(static_cast<int>(i))));
      if (rows[i].empty() || std::abs(row.commanded - rows[i].back().commanded) >= apart)
        rows[i].push_back(row);
    }
  }
  return rows;
}

}  // namespace

AxisSeries axis_series(const machine::RecordedMotion& motion, const machine::MachineDescription& machine,
                       const machine::LoadEncoderCounts& counts) {
  AxisSeries series;
  series.drives = rows_of(motion.drives, motion, machine, {});
  if (!motion.load.empty()) series.load = rows_of(motion.load, motion, machine, counts);
  return series;
}

}  // namespace understudy::calibration
