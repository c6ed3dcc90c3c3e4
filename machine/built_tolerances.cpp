#include "machine/built_tolerances.h"

namespace understudy::machine {
namespace {

constexpr Bounds kShare{0, 500};  // [permille]: three sigma of more would turn a value round

/// A map that may be left out, of keys that may be left out.
struct Keys {
  YamlMap& map;
  void read(const std::string& key, Bounds bounds, const char* about, double& value) {
    if (map.has(key)) value = map.quantity(key, bounds, about);
  }
};

void read_drives(Keys keys, BuiltTolerances& t) {
  keys.read("lead_permille", kShare, "of the travel of each drive", t.lead);
  keys.read("periodic_um", {0, 1000}, "amplitude over a turn of each motor", t.periodic);
  keys.read("play_permille", kShare, "of each play", t.play);
}

void read_optics(Keys keys, BuiltTolerances& t) {
  keys.read("camera_centre_px", {0, 1000}, "each coordinate of the principal point", t.camera_centre);
  keys.read("distortion_k1", {0, 1}, "of the lens", t.distortion);
  keys.read("laser_power_permille", kShare, "of the laser's grey levels", t.laser_power);
  keys.read("waist_permille", kShare, "of the beam's waist", t.waist);
  keys.read("blur_permille", kShare, "of the optics' blur", t.blur);
  keys.read("ambient_light_permille", kShare, "of the grey levels without the laser", t.ambient_light);
}

void read_table(Keys keys, BuiltTolerances& t) {
  keys.read("height_mm", {0, 5}, "of the table's top", t.table_height);
  keys.read("tilt_mrad", {0, 100}, "of the table's top, about x and y of W", t.table_tilt);
  keys.read("flatness_um", {0, 5000}, "of the table's top, middle against rim", t.table_flatness);
}

void read_process(Keys keys, BuiltTolerances& t) {
  keys.read("filament_diameter_mm", {0, 0.5}, "of the filament", t.filament_diameter);
  keys.read("extruder_lag_permille", kShare, "of the extruder's lag", t.extruder_lag);
  keys.read("nozzle_temperature_k", {0, 30}, "what the nozzle's sensor misses", t.nozzle_temperature);
}

}  // namespace

void read_part_tolerances(YamlMap& map, BuiltTolerances& t) {
  Keys keys{map};
  keys.read("position_mm", {0, 5}, "each coordinate of the clamped part", t.part_position);
  keys.read("rotation_mrad", {0, 100}, "of the clamped part, about each axis of W", t.part_rotation);
  keys.read("size_permille", {0, 100}, "of the part's size", t.part_size);
  keys.read("ripple_um", {0, 1000}, "amplitude of waves of its surface", t.part_ripple);
}

void read_built_tolerances(YamlMap& map, BuiltTolerances& tolerances) {
  const auto section = [&](const char* name, const char* about, auto read) {
    if (map.has(name)) map.section(name, about, [&](YamlMap& keys) { read(Keys{keys}, tolerances); });
  };
  section("drives", "screws and joints", read_drives);
  section("optics", "laser and camera", read_optics);
  if (map.has("part"))
    map.section("part", "what is clamped on the table",
                [&](YamlMap& keys) { read_part_tolerances(keys, tolerances); });
  section("table", "what the work stands on", read_table);
  section("process", "filament and nozzle", read_process);
}

}  // namespace understudy::machine
