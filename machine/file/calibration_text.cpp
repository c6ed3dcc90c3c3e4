// The section `calibration` as text.
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "machine/file/calibration_section.h"
#include "machine/file/mount_key.h"
#include "machine/file/section_text.h"

namespace understudy::machine {
namespace {

std::string unit_text(const Vec3& v) {
  return fmt::format("[{:.12f}, {:.12f}, {:.12f}]", v.x(), v.y(), v.z());
}

std::string struts_text(const kinematics::HexapodGeometry& g) {
  std::string out = fmt::format("  deviation_mm: {:.9f}\n  struts:\n", to_mm(g.deviation));
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    out += fmt::format("    - {{base_joint_mm: {}, platform_joint_mm: {}, length_offset_mm: {:.9f}}}\n",
                       vector_text(g.base_joint[i], kMillimetre),
                       vector_text(g.platform_joint[i], kMillimetre), to_mm(g.length_offset[i]));
  return out;
}

std::string axes_text(const kinematics::Chain& chain) {
  std::string out = mount_text("tool", chain.X_OT_zero) + mount_text("work", chain.X_OS_zero) + "  axes:\n";
  for (const kinematics::ChainAxis& axis : chain.axes) {
    out += fmt::format("    - {{axis: {}, direction: {}", quoted_text(axis.name), unit_text(axis.direction));
    if (axis.angle) out += fmt::format(", point_mm: {}", vector_text(axis.point, kMillimetre));
    out += "}\n";
  }
  return out;
}

}  // namespace

std::string calibration_section(const MachineDescription& machine, const CalibratedParameters& parameters) {
  const CalibrationRecord& record = *machine.calibration;
  std::string out = fmt::format(
      "calibration:\n  # By understudy calibrate: the controller uses this in place of `geometry`.\n"
      "  estimator: {}\n  measurements: {}\n  measurements_sha256: {}\n  poses: {}\n",
      quoted_text(record.estimator), quoted_text(record.measurements),
      quoted_text(record.measurements_sha256), record.poses);
  if (std::isfinite(record.tip_sigma))
    out += fmt::format("  tip_sigma_um: {:.3f}   # RMS over the work space\n", to_um(record.tip_sigma));
  out += machine.visit([](const HexapodModel& hexapod) { return struts_text(hexapod.geometry); },
                       [](const ChainModel& chain) { return axes_text(chain.kinematics.chain); });
  return out + calibrated_parameters_text(machine, parameters);
}

void write_calibrated(const MachineDescription& machine, const std::filesystem::path& path,
                      const CalibratedParameters& parameters) {
  write_with_section(machine.file, calibration_section(machine, parameters), path);
}

}  // namespace understudy::machine
