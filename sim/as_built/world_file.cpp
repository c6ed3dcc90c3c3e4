#include "sim/as_built/world_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/optics_mounting.h"
#include "sim/as_built/file_parts.h"

namespace understudy::sim {
namespace {

constexpr double kPermille = 1e-3;
constexpr Bounds kPhase{-360, 360};

void read_drives(YamlMap& root, AsBuilt& built) {
  kinematics::PerAxis<bool> told{};
  root.list("drives", 0, "those that differ", [&](YamlMap& map, std::size_t) {
    const int number = map.integer("drive", 1, static_cast<int>(built.drives.size()), "of its axis");
    map.require("drive");
    const auto i = static_cast<std::size_t>(number - 1);
    if (told[i] && !map.recording())
      throw InputError(map.place("drive"),
                       fmt::format("{} names a part that was told before", map.path("drive")));
    told[i] = true;
    read_if_given(map, "lead_permille", {-500, 500}, "more travel than its motor's turns say",
                  built.drives[i].scale);
    read_if_given(map, "periodic_um", {0, 1000}, "amplitude over a turn of the motor",
                  built.drives[i].periodic);
    read_if_given(map, "phase_deg", kPhase, "of that at reading 0", built.drives[i].phase);
  });
}

void read_camera(YamlMap& map, machine::Microscope& microscope) {
  read_mount(map, {"lens_mm", "quaternion", "the lens in T"}, microscope.X_TC);
  read_if_given(map, "focal_px", {1, 1e6}, "focal length", microscope.camera.focal_px);
  if (map.has("centre_px")) {
    const auto centre = map.quantities("centre_px", 2, {-10000, 20000}, "principal point");
    microscope.camera.centre_px = {centre[0], centre[1]};
  }
  if (map.has("distortion")) {
    const auto brown = map.quantities("distortion", 4, {-10, 10}, "of the lens: k1, k2, p1, p2");
    machine::set_distortion(brown, microscope.camera);
  }
  read_if_given(map, "blur_px", {0, 50}, "of the optics, 1 sigma", microscope.blur_px);
  read_if_given(map, "ambient_levels", {0, 254}, "grey levels without the laser", microscope.ambient_level);
}

void read_laser(YamlMap& map, machine::Laser& laser) {
  read_mount(map, {"front_mm", "quaternion", "its front in T"}, laser.X_TL);
  read_if_given(map, "waist_diameter_mm", {0.005, 5}, "1/e^2 diameter at the surface", laser.waist_diameter);
  read_if_given(map, "peak_levels", {1, 255}, "grey levels of the spot's centre", laser.peak_level);
}

void read_part(YamlMap& map, BuiltPart& part) {
  read_mount(map, {"position_mm", "quaternion", "the clamped part in W"}, part.X_WF);
  if (map.has("size")) part.size = map.number("size", {0.5, 2}, "of the drawn part");
  read_if_given(map, "ripple_um", {0, 1000}, "amplitude of waves of its surface", part.ripple);
  read_if_given(map, "phase_deg", kPhase, "of the waves", part.phase);
}

void read_table(YamlMap& map, geometry::TableSurface& table) {
  read_if_given(map, "height_mm", {-50, 50}, "of its top at the origin of W", table.height);
  if (map.has("slope_mrad")) {
    const auto slope = map.quantities("slope_mrad", 2, {-100, 100}, "of its top, along x and y");
    table.slope = {slope[0], slope[1]};
  }
  read_if_given(map, "bow_um", {-5000, 5000}, "by which its rim lies lower than its middle", table.bow);
}

void read_process(YamlMap& map, AsBuilt& built) {
  read_if_given(map, "filament_diameter_mm", {0.1, 20}, "of the filament that is fed",
                built.filament_diameter);
  read_if_given(map, "extruder_lag_ms", {0, 2000}, "from the drive's feed to the flow", built.extruder_lag);
  read_if_given(map, "nozzle_offset_k", {-100, 100}, "the nozzle beyond what its sensor reads",
                built.nozzle_offset);
}

std::string drives_text(const kinematics::PerAxis<DriveError>& drives) {
  std::string out;
  for (std::size_t i = 0; i < drives.size(); ++i)
    if (drives[i].scale != 0 || drives[i].periodic != 0)
      out += fmt::format("  - {{drive: {}, lead_permille: {}, periodic_um: {}, phase_deg: {}}}\n", i + 1,
                         drives[i].scale / kPermille, to_um(drives[i].periodic), to_deg(drives[i].phase));
  return out.empty() ? out : "drives:\n" + out;
}

std::string optics_text(const AsBuilt& built) {
  const machine::Microscope& microscope = built.microscope;
  const Camera& camera = microscope.camera;
  return fmt::format(
      "laser: {{front_mm: {}, quaternion: {}, waist_diameter_mm: {}, peak_levels: {}}}\n"
      "camera: {{lens_mm: {}, quaternion: {}, focal_px: {}, centre_px: [{}, {}], "
      "distortion: [{}, {}, {}, {}], blur_px: {}, ambient_levels: {}}}\n",
      vector_text(built.laser.X_TL.translation(), kMillimetre), rotation_text(built.laser.X_TL),
      to_mm(built.laser.waist_diameter), built.laser.peak_level,
      vector_text(microscope.X_TC.translation(), kMillimetre), rotation_text(microscope.X_TC),
      camera.focal_px, camera.centre_px.x(), camera.centre_px.y(), camera.k1, camera.k2, camera.p1, camera.p2,
      microscope.blur_px, microscope.ambient_level);
}

}  // namespace

void read_world(YamlMap& root, AsBuilt& built) {
  if (root.has("drives")) read_drives(root, built);
  const auto section = [&](const char* name, const char* about, auto read) {
    if (root.has(name)) root.section(name, about, read);
  };
  if (root.either("the machine sees the gap", built.laser.waist_diameter > 0)) {
    section("laser", "the beam", [&](YamlMap& map) { read_laser(map, built.laser); });
    section("camera", "of the microscope", [&](YamlMap& map) { read_camera(map, built.microscope); });
  }
  section("part", "what is clamped on the table", [&](YamlMap& map) { read_part(map, built.part); });
  section("table", "its top", [&](YamlMap& map) { read_table(map, built.table); });
  if (root.either("the machine prints", built.filament_diameter > 0))
    section("process", "filament and nozzle", [&](YamlMap& map) { read_process(map, built); });
}

std::string write_world(const AsBuilt& built) {
  std::string out = drives_text(built.drives);
  if (built.laser.waist_diameter > 0) out += optics_text(built);
  const BuiltPart& part = built.part;
  out += fmt::format("part: {{position_mm: {}, quaternion: {}, size: {}, ripple_um: {}, phase_deg: {}}}\n",
                     vector_text(part.X_WF.translation(), kMillimetre), rotation_text(part.X_WF), part.size,
                     to_um(part.ripple), to_deg(part.phase));
  const geometry::TableSurface& table = built.table;
  out += fmt::format("table: {{height_mm: {}, slope_mrad: [{}, {}], bow_um: {}}}\n", to_mm(table.height),
                     to_mrad(table.slope.x()), to_mrad(table.slope.y()), to_um(table.bow));
  if (built.filament_diameter > 0)
    out += fmt::format("process: {{filament_diameter_mm: {}, extruder_lag_ms: {}, nozzle_offset_k: {}}}\n",
                       to_mm(built.filament_diameter), built.extruder_lag / 1e-3, built.nozzle_offset);
  return out;
}

}  // namespace understudy::sim
