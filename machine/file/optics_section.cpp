#include "machine/file/optics_section.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "machine/optics_mounting.h"

namespace understudy::machine {
namespace {

// A picture is drawn with four samples a pixel, of 160 bytes together (sim/sensors): 2.6 GB at most.
constexpr int kMostInARow = 8000, kMostPixels = 16'000'000;

/// Pose in T of a device that looks from azimuth and angle (from the tool's axis) at `target`. z is its line
/// of sight, x the horizontal to its right, y the image's down.
Pose aimed(double azimuth, double angle, const Vec3& target, double distance) {
  const Vec3 outward(std::cos(azimuth), std::sin(azimuth), 0);
  const Vec3 sight = -(std::sin(angle) * outward + std::cos(angle) * Vec3::UnitZ());
  const Vec3 right = Vec3::UnitZ().cross(outward);
  Mat3 R;
  R << right, sight.cross(right), sight;
  return make_pose(R, Vec3(target - distance * sight));
}

}  // namespace

void read_laser(YamlMap& map, Laser& laser) {
  const double azimuth =
      map.quantity("azimuth_deg", {-360, 360}, "where it stands, about the tool's axis from +x towards +y");
  const double angle = map.quantity("angle_deg", {5, 80}, "between its line of sight and the tool's axis");
  const double crossing = map.quantity("crosses_tip_plane_mm", {0, 50},
                                       "where the beam meets the plane of the tip, from the tool's axis");
  const double distance = map.quantity("distance_mm", {1, 1000}, "from that point to the device");
  laser.X_TL = aimed(azimuth, angle, crossing * Vec3(std::cos(azimuth), std::sin(azimuth), 0), distance);
  laser.waist_diameter = map.quantity("waist_diameter_mm", {0.005, 5}, "1/e^2 diameter at the surface");
  laser.wavelength = map.quantity("wavelength_nm", {300, 1100}, "of the laser's light");
  laser.peak_level = map.quantity("peak_levels", {1, 255},
                                  "grey levels of the spot's centre on a matt surface facing the beam");
}

void read_microscope(YamlMap& map, Microscope& microscope) {
  const double azimuth =
      map.quantity("azimuth_deg", {-360, 360}, "where it stands, about the tool's axis from +x towards +y");
  const double angle = map.quantity("angle_deg", {0, 80}, "between its line of sight and the tool's axis");
  const Vec3 target = map.vector("looks_at_mm", {-50, 50}, "point in T");
  const double distance = map.quantity("distance_mm", {1, 1000}, "from that point to the device");
  microscope.X_TC = aimed(azimuth, angle, target, distance);

  Camera& camera = microscope.camera;
  camera.width = map.integer("width_px", 16, kMostInARow, "of the sensor");
  camera.height = map.integer("height_px", 16, kMostInARow, "of the sensor");
  if (camera.width * camera.height > kMostPixels)
    map.fail("width_px",
             fmt::format("the sensor of the microscope has {} x {} px, more than {} (docs/limits.md)",
                         camera.width, camera.height, kMostPixels));
  camera.focal_px = map.quantity("scale_px_per_mm", {0.1, 10000}, "at the point looked at") * distance;
  const std::vector<double> centre = map.quantities("centre_px", 2, {-10000, 20000}, "principal point");
  camera.centre_px = {centre[0], centre[1]};
  const std::vector<double> distortion =
      map.quantities("distortion", 4, {-10, 10}, "of the lens: k1, k2, p1, p2 (Brown)");
  set_distortion(distortion, camera);

  microscope.exposure = map.quantity("exposure_ms", {0.001, 10000}, "of a frame");
  microscope.transfer =
      map.quantity("transfer_ms", {0, 10000}, "from the end of exposure until the controller has the frame");
  microscope.aperture_sine =
      map.quantity("aperture_sine", {0.002, 0.999}, "sin u on the object side: speckle and depth noise");
  microscope.blur_px = map.quantity("blur_px", {0, 50}, "of the optics, 1 sigma");
  microscope.full_well = map.quantity("full_well_electrons", {100, 1e7}, "at 255 grey levels");
  microscope.read_noise = map.quantity("read_noise_electrons", {0, 1e4}, "1 sigma");
  microscope.ambient_level = map.quantity("ambient_levels", {0, 254}, "grey levels without the laser");
}

void check_optics(const YamlMap& root, const MachineDescription& machine) {
  const Vec3 origin = machine.laser.X_TL.translation(), beam = machine.laser.X_TL.linear().col(2);
  const auto on_beam = [&](double z) -> Vec3 { return origin + (z - origin.z()) / beam.z() * beam; };
  const double crossing = on_beam(0).head<2>().norm(), flat = machine.tool.flat_diameter / 2;
  if (crossing <= flat)
    throw InputError(root.place("laser"),
                     fmt::format("laser.crosses_tip_plane_mm is {:g} mm from the tool axis, within "
                                 "the nozzle's flat of radius {:g} mm",
                                 to_mm(crossing), to_mm(flat)));
  const Microscope& microscope = machine.microscope;
  const Vec3 dot_C = microscope.X_TC.inverse() * on_beam(-machine.gap.aim);
  const std::optional<Vec2> pixel = microscope.camera.project(dot_C);
  const bool seen = pixel && pixel->x() >= 0 && pixel->y() >= 0 &&
                    pixel->x() <= microscope.camera.width - 1 && pixel->y() <= microscope.camera.height - 1;
  if (!seen)
    throw InputError(
        root.place("microscope"),
        fmt::format(
            "the microscope does not see the dot at the gap aimed at, {:g} mm: {} on a sensor of {} x {} px",
            to_mm(machine.gap.aim),
            pixel ? fmt::format("it falls on ({:.1f}, {:.1f}) px", pixel->x(), pixel->y())
                  : "it is behind it",
            microscope.camera.width, microscope.camera.height));
}

}  // namespace understudy::machine
