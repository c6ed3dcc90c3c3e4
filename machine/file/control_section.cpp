#include "machine/file/control_section.h"

namespace understudy::machine {
namespace {

/// Keys that may be left out.
class Optional {
 public:
  explicit Optional(YamlMap& map) : map_(map) {}
  void quantity(const char* key, Bounds bounds, const char* about, double& value) {
    if (map_.has(key)) value = map_.quantity(key, bounds, about);
  }
  void number(const char* key, Bounds bounds, const char* about, double& value) {
    if (map_.has(key)) value = map_.number(key, bounds, about);
  }
  void integer(const char* key, int low, int high, const char* about, int& value) {
    if (map_.has(key)) value = map_.integer(key, low, high, about);
  }

 private:
  YamlMap& map_;
};

constexpr Bounds kMillimetres{0.001, 100}, kMilliseconds{0.1, 60'000}, kSeconds{0.001, 600};

void read_planner(YamlMap& map, PlannerSettings& planner) {
  Optional keys(map);
  keys.quantity("lookahead_mm", {1, 10'000}, "path that is planned ahead", planner.lookahead);
  keys.number("corner_share", {0.01, 0.99}, "of an axis' acceleration in a cycle that a corner may take",
              planner.corner_share);
  keys.quantity("lead_time_ms", {1, 5000}, "a stretch begins this far ahead", planner.lead_time);
  keys.number("gap_reserve", {0, 0.9}, "of axis speed and acceleration, kept for gap control",
              planner.gap_reserve);
}

void read_approach(YamlMap& map, GapApproachSettings& approach) {
  Optional keys(map);
  keys.quantity("tolerance_um", {0.1, 1000}, "stop when the reading is this near to the aim",
                approach.tolerance);
  keys.number("step_fraction", {0.01, 0.95}, "gain: of the distance left, a step outside the slow zone",
              approach.step_fraction);
  keys.quantity("slow_zone_mm", kMillimetres, "above the aim: frames are averaged and steps shortened",
                approach.slow_zone);
  keys.integer("frames_averaged", 1, 100, "in the slow zone", approach.frames_averaged);
  keys.integer("stops_max", 1, 10'000, "steps before giving up", approach.stops_max);
  keys.quantity("residual_max_px", {0.1, 1000}, "farther off its line, the dot is implausible",
                approach.residual_max_px);
  keys.quantity("depth_max_mm", kMillimetres, "below the start: lower is another surface",
                approach.depth_max);
  keys.quantity("settle_ms", kMilliseconds, "rest before an exposure", approach.settle_time);
  keys.quantity("frame_age_max_ms", kMilliseconds, "an older frame is stale", approach.frame_age_max);
  keys.quantity("retreat_mm", kMillimetres, "along the tool axis, after a stop", approach.retreat);
}

void read_following(YamlMap& map, GapFollowingSettings& following, GapLineSettings& line) {
  Optional keys(map);
  keys.quantity("rate_max_mm_per_s", {0.001, 100}, "of the correction", following.rate_max);
  keys.quantity("acceleration_max_mm_per_s2", {0.01, 10'000}, "of the correction",
                following.acceleration_max);
  keys.quantity("travel_max_mm", kMillimetres, "of the correction, both ways", following.travel_max);
  keys.quantity("settle_ms", kMilliseconds, "gain: a step of the estimate is taken over in this time",
                following.settle_time);
  keys.number("gate_sigmas", {1, 100}, "standard deviations that a reading may be off", following.gate);
  keys.quantity("unmodelled_um", {0.01, 1000}, "a reading may be off besides", following.unmodelled);
  keys.integer("step_samples", 2, 100, "readings in a row that show a lasting step", following.step_samples);
  keys.quantity("extrapolated_max_mm", kMillimetres, "path beyond the last good reading",
                following.extrapolated_max);
  keys.quantity("blind_s", kSeconds, "without a good reading, and blind_mm of path, is a stop",
                following.blind_time);
  keys.quantity("blind_mm", kMillimetres, "without a good reading, and blind_s, is a stop",
                following.blind_path);
  keys.quantity("blind_max_s", kSeconds, "without a good reading is a stop", following.blind_time_max);
  keys.quantity("silent_max_s", kSeconds, "of asking readings without an answer", following.silent_time_max);
  keys.number("slope_sigma", {1e-6, 10}, "1 sigma of the gap's slope, before it was measured",
              line.slope_sigma);
  keys.number("slope_walk_per_m", {1e-6, 100},
              "variance of the slope's change over a metre: the filter's gain", line.slope_walk);
  keys.quantity("drift_um", {0.001, 1000}, "of the gap at rest, in a second", line.drift);
}

}  // namespace

void read_control_section(YamlMap& root, ControlSettings& settings) {
  if (root.has("planner"))
    root.section("planner", "how motions are planned",
                 [&](YamlMap& map) { read_planner(map, settings.planner); });
  if (!root.has("gap_control")) return;
  root.section("gap_control", "gains and limits of gap control", [&](YamlMap& map) {
    if (map.has("approach"))
      map.section("approach", "how the gap is closed before a bead",
                  [&](YamlMap& keys) { read_approach(keys, settings.gap.approach); });
    if (map.has("following"))
      map.section("following", "how the gap is followed along a bead",
                  [&](YamlMap& keys) { read_following(keys, settings.gap.following, settings.gap.line); });
  });
}

}  // namespace understudy::machine
