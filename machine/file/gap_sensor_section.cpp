#include "machine/file/gap_sensor_section.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "machine/file/covariance_key.h"
#include "machine/file/mount_key.h"
#include "machine/file/section_text.h"
#include "machine/optics_mounting.h"

namespace understudy::machine {
namespace {

constexpr const char* kCovariance = "covariance_mm_rad";
constexpr const char* kWaist = "waist_diameter_mm";
constexpr const char* kWaistSigma = "waist_sigma_um";
constexpr const char* kWriter = "understudy calibrate gap-sensor";

Eigen::VectorXd covariance_units() {
  Eigen::VectorXd units(kMountingFreedoms);
  for (int i = 0; i < kMountingFreedoms; ++i) units[i] = mounting_file_unit(i);
  return units;
}

Pose read_device(YamlMap& map, const std::string& body, const Pose& drawn) {
  const Pose X = read_mount(map, body, "T");
  if (!map.complete()) return drawn;
  const double apart = (X.translation() - drawn.translation()).norm();
  if (apart > kMountingFar)
    throw InputError(map.place(body + "_mm"),
                     fmt::format("the {} is {:.1f} mm from where its section has it, more than {:.0f} mm: is "
                                 "this the calibration of another machine?",
                                 body, to_mm(apart), to_mm(kMountingFar)));
  const double turned = angle_between(X.linear(), drawn.linear());
  if (turned > kMountingTurned)
    throw InputError(map.place(body + "_quaternion"),
                     fmt::format("the {} is turned by {:.1f} deg from where its section has it, more than "
                                 "{:.1f} deg: is this the calibration of another machine?",
                                 body, to_deg(turned), to_deg(kMountingTurned)));
  return X;
}

/// A calibration from before it measured the beam has neither key.
void read_waist(YamlMap& map, Laser& laser, GapSensorCalibration& record) {
  if (!map.has(kWaist) && !map.has(kWaistSigma)) return;
  const double found = map.quantity(kWaist, {0.005, 5}, "of the beam, as its dots show it");
  const double sigma = map.quantity(kWaistSigma, {0, 1000}, "1 sigma of that");
  if (!map.complete()) return;
  const double off = found / laser.waist_diameter - 1;
  if (std::abs(off) > kWaistOff)
    throw InputError(
        map.place(kWaist),
        fmt::format("{} is {:g} mm, {:+.0f} % off the drawn {:g} mm, more than {:.0f} %: is this "
                    "the calibration of another machine?",
                    map.path(kWaist), to_mm(found), 100 * off, to_mm(laser.waist_diameter), 100 * kWaistOff));
  record.waist = MeasuredWaist{laser.waist_diameter, sigma};
  laser.waist_diameter = found;
}

std::string waist_text(const MachineDescription& machine) {
  if (!machine.gap_sensor->waist) return "";
  return fmt::format("  {}: {:.6f}\n  {}: {:.3f}\n", kWaist, to_mm(machine.laser.waist_diameter), kWaistSigma,
                     to_um(machine.gap_sensor->waist->sigma));
}

void read_section(YamlMap& map, MachineDescription& machine) {
  GapSensorCalibration record;
  record.drawn = mounting_of(machine);
  record.measurements = map.text("measurements", "name of the table of pictures");
  record.measurements_sha256 = map.text("measurements_sha256", "checksum of its bytes");
  record.pictures = map.integer("pictures", 1, 1000000, "whose dots were used");
  OpticsMounting found;
  found.X_TL = read_device(map, "laser", record.drawn.X_TL);
  found.X_TC = read_device(map, "microscope", record.drawn.X_TC);
  found.focal_px = map.quantity("focal_px", {1, 1e8}, "focal length over the width of a pixel");
  const Eigen::MatrixXd covariance = read_covariance(map, kCovariance, covariance_units(), kWriter);
  Laser laser = machine.laser;
  read_waist(map, laser, record);
  if (!map.complete()) return;
  const double scale = found.focal_px / record.drawn.focal_px - 1;
  if (std::abs(scale) > kMountingScaleOff)
    throw InputError(
        map.place("focal_px"),
        fmt::format("{} is {:g} px, {:+.1f} % off the drawn {:g} px, more than {:.0f} %: is this "
                    "the calibration of another machine?",
                    map.path("focal_px"), found.focal_px, 100 * scale, record.drawn.focal_px,
                    100 * kMountingScaleOff));
  record.covariance = covariance;
  machine.laser = laser;
  set_mounting(found, machine.laser, machine.microscope);
  machine.gap_sensor = record;
}

}  // namespace

void read_gap_sensor(YamlMap& root, MachineDescription& machine) {
  if (!machine.has_microscope)
    return root.refuse("gap_sensor", "a machine without laser and microscope has no gap sensor");
  if (!root.has("gap_sensor")) return;
  if (!root.complete() && !root.recording()) return;  // nothing to compare with
  root.section("gap_sensor", "laser and microscope as a calibration found them, in place of the drawn ones",
               [&](YamlMap& map) { read_section(map, machine); });
}

std::string gap_sensor_section(const MachineDescription& machine) {
  const GapSensorCalibration& record = *machine.gap_sensor;
  const std::string head = fmt::format(
      "gap_sensor:\n  # By {}: the controller uses this in place of the mounting of `laser` and "
      "`microscope`.\n  measurements: {}\n  measurements_sha256: {}\n  pictures: {}\n",
      kWriter, quoted_text(record.measurements), quoted_text(record.measurements_sha256), record.pictures);
  return head + mount_text("laser", machine.laser.X_TL) + mount_text("microscope", machine.microscope.X_TC) +
         fmt::format("  focal_px: {:.9f}\n", machine.microscope.camera.focal_px) + waist_text(machine) +
         covariance_text(kCovariance, record.covariance, covariance_units(),
                         "docs/machine-description.md#gap-sensor");
}

}  // namespace understudy::machine
