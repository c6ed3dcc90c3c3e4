#include "rehearsal/figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

class Figures {
 public:
  void section(const char* name) { section_ = name; }
  void put(const std::string& name, double value) { all_.push_back({section_, name, value}); }
  void put(const std::string& name, const std::optional<double>& value) {
    if (value) put(name, *value);
  }
  void count(const std::string& name, std::uint64_t value) { all_.push_back({section_, name, value}); }
  void count(const std::string& name, int value) { count(name, static_cast<std::uint64_t>(value)); }
  void text(const std::string& name, const std::string& value) { all_.push_back({section_, name, value}); }
  void texts(const std::string& name, const std::vector<std::string>& value) {
    if (!value.empty()) all_.push_back({section_, name, value});
  }
  void texts(const std::string& name, const std::map<std::string, std::string>& value) {
    if (!value.empty()) all_.push_back({section_, name, value});
  }
  std::vector<Figure> take() { return std::move(all_); }

 private:
  std::string section_;
  std::vector<Figure> all_;
};

/// How the programmed tool's axis leans from upright and turns, summed, while it extrudes.
struct Turning {
  double tilt_max = 0, turned = 0;  // [rad]
};

Turning turning_of(const std::vector<TracePoint>& trace) {
  Turning turning;
  bool extruded = false;
  Vec3 last = Vec3::UnitZ();
  for (const TracePoint& point : trace) {
    const Vec3 axis = tool_axis(point.X_WT_programmed);
    if (point.extruding) {
      turning.tilt_max = std::max(turning.tilt_max, std::atan2(axis.head<2>().norm(), axis.z()));
      if (extruded) turning.turned += std::atan2(last.cross(axis).norm(), last.dot(axis));
    }
    last = axis;
    extruded = point.extruding;
  }
  return turning;
}

void add(const PrintFigures& print, const std::vector<TracePoint>& trace, Figures& to) {
  const Turning turning = turning_of(trace);
  to.section("print");
  to.put("duration_s", print.duration_s);
  to.count("moves", print.moves);
  to.put("extruded_mm", print.extruded_mm);
  to.put("printed_mm", print.printed_mm);
  to.put("purged_mm", print.purged_mm);
  to.put("missing_mm", print.missing_mm);
  to.put("primed_mm", print.primed_mm);
  to.put("deposited_mm", print.deposited_mm);
  to.put("spanning_mm", print.spanning_mm);
  to.put("travel_mm", print.travel_mm);
  to.put("tilt_max_deg", to_deg(turning.tilt_max));
  to.put("turned_deg", to_deg(turning.turned));
  to.put("fill_factor", print.fill_factor);
}

void add(const PlacementFigures& placement, Figures& to) {
  to.section("placement");
  const auto& [x, y, z] = placement.place_mm;
  to.put("x_mm", x);
  to.put("y_mm", y);
  to.put("z_mm", z);
  to.put("turn_deg", placement.turn_deg);
  to.put("spin_deg", placement.spin_deg);
  to.put("margin", placement.margin);
  to.text("least", placement.least);
  if (!placement.refused.empty()) to.text("refused", placement.refused);
}

void add(const AccuracyFigures& accuracy, const Record& record, Figures& to) {
  to.section("accuracy");
  to.put("tip_rms_um", accuracy.tip_rms_um);
  to.put("tip_p95_um", accuracy.tip_p95_um);
  to.put("tip_max_um", accuracy.tip_max_um);
  to.put("orientation_max_mrad", accuracy.orientation_max_mrad);
  to.put("open_loop_tip_max_um", accuracy.open_loop_tip_max_um);
  to.put("tip_tolerance_mm", record.tip_tolerance_mm);
  to.put("orientation_tolerance_deg", record.orientation_tolerance_deg);
}

void add(const CalibrationFigures& calibration, Figures& to) {
  to.section("calibration");
  to.text("machine_before", calibration.machine_before);
  to.text("machine_after", calibration.machine_after);
  if (!calibration.not_run_before.empty()) to.text("not_run_before", calibration.not_run_before);
  const auto pair = [&](const std::string& name, const std::string& unit, double AccuracyFigures::*figure) {
    if (calibration.before) to.put(name + "_before_" + unit, *calibration.before.*figure);
    to.put(name + "_after_" + unit, calibration.after.*figure);
  };
  pair("tip_rms", "um", &AccuracyFigures::tip_rms_um);
  pair("tip_p95", "um", &AccuracyFigures::tip_p95_um);
  pair("tip_max", "um", &AccuracyFigures::tip_max_um);
  pair("orientation_max", "mrad", &AccuracyFigures::orientation_max_mrad);
}

void add(const GapFigures& gap, Figures& to) {
  to.section("gap");
  to.put("commanded_mm", gap.commanded_mm);
  if (gap.open_loop_start_mm) to.put("open_loop_start_mm", *gap.open_loop_start_mm);
  to.put("start_mm", gap.start_mm);
  to.put("path_min_mm", gap.path_min_mm);
  to.put("path_mean_mm", gap.path_mean_mm);
  to.put("path_max_mm", gap.path_max_mm);
  to.put("in_band_fraction", gap.in_band_fraction);
  to.count("frames", gap.frames);
  to.put("believed_mean_mm", gap.believed_mean_mm);
  to.put("stated_sigma_um", gap.stated_sigma_um);
  to.put("stated_path_fraction", gap.stated_path_fraction);
  to.put("inside_stated_3_sigma_fraction", gap.inside_stated_3_sigma_fraction);
}

void add(const RegistrationFigures& found, Figures& to) {
  to.section("registration");
  to.count("places", found.places);
  to.count("left_out", found.left_out);
  to.put("duration_s", found.duration_s);
  if (!found.refused.empty()) to.text("refused", found.refused);
  if (!found.fit) return;
  to.count("seen", found.seen);
  to.texts("unseen", found.unseen);
  const char* axes[] = {"x", "y", "z"};
  const auto put_each = [&](const std::string& what, const std::array<double, 3>& values, const char* unit) {
    for (std::size_t i = 0; i < 3; ++i) to.put(what + axes[i] + unit, values[i]);
  };
  put_each("reference_", found.reference_mm, "_mm");
  put_each("shift_", found.shift_um, "_um");
  put_each("shift_sigma_", found.shift_sigma_um, "_um");
  put_each("turn_", found.turn_mrad, "_mrad");
  put_each("turn_sigma_", found.turn_sigma_mrad, "_mrad");
  to.put("chi_square", found.chi_square);
  to.count("degrees_of_freedom", found.degrees_of_freedom);
  to.put("chi_square_limit", found.chi_square_limit);
  to.put("place_sigma_um", found.place_sigma_um);
  to.put("normal_sigma_max_um", found.normal_sigma_max_um);
  if (!found.normal_error_rms_um) return;
  to.put("normal_error_rms_um", *found.normal_error_rms_um);
  to.put("normal_error_max_um", found.normal_error_max_um);
}

void add(const SagFigures& sag, Figures& to) {
  to.section("sag");
  to.put("max_um", sag.max_um);
  to.count("strands", sag.strands);
  to.put("unsupported_mm", sag.unsupported_mm);
  if (sag.strands == 0) return;
  to.put("diameter_min_mm", sag.diameter_min_mm);
  to.put("diameter_max_mm", sag.diameter_max_mm);
}

void add(const CollisionFigures& collision, Figures& to) {
  to.section("collision");
  if (collision.min_clearance_mm) to.put("min_clearance_mm", *collision.min_clearance_mm);
  if (!collision.closest.empty()) to.text("closest", collision.closest);
  if (collision.nozzle_clearance_mm) to.put("nozzle_clearance_mm", *collision.nozzle_clearance_mm);
  to.count("checks", collision.checks);
  to.count("pairs", collision.pairs);
}

void add(const SurfaceFigures& surface, Figures& to) {
  to.section("surface");
  if (surface.ra_um) to.put("ra_um", *surface.ra_um);
  if (surface.rz_um) to.put("rz_um", *surface.rz_um);
  if (surface.deviation_p95_um) to.put("deviation_p95_um", *surface.deviation_p95_um);
}

void add(const RemovalFigures& removal, Figures& to) {
  to.section("removal");
  to.put("spacing_mm", removal.spacing_mm);
  to.put("finished_fraction", removal.finished_fraction);
  to.put("left_over_mean_um", removal.left_over_mean_um);
  to.put("left_over_p95_um", removal.left_over_p95_um);
  to.put("left_over_max_um", removal.left_over_max_um);
  to.put("planned_left_over_p95_um", removal.planned_left_over_p95_um);
  to.put("planned_left_over_max_um", removal.planned_left_over_max_um);
  to.put("gouge_um", removal.gouge_um);
  to.put("planned_gouge_um", removal.planned_gouge_um);
  if (removal.gouge_um > 0) {
    const char* names[] = {"gouge_x_mm", "gouge_y_mm", "gouge_z_mm"};
    for (std::size_t i = 0; i < 3; ++i) to.put(names[i], removal.gouge_mm[i]);
    to.count("gouge_line", removal.gouge_line);
  }
  to.put("volume_mm3", removal.volume_mm3);
}

void add(const EngineFigures& engine, Figures& to) {
  to.section("engine");
  to.text("name", engine.name);
  to.text("version", engine.version);
  to.put("timestep_s", engine.timestep_s);
  to.count("steps", engine.steps);
  to.put("closure_max_um", engine.closure_max_um);
}

void add(const Provenance& provenance, Figures& to) {
  to.section("provenance");
  to.text("version", provenance.version);
  to.text("machine_sha256", provenance.machine_sha256);
  if (!provenance.machine_before_sha256.empty())
    to.text("machine_before_sha256", provenance.machine_before_sha256);
  to.text("program_sha256", provenance.program_sha256);
  if (!provenance.inputs_sha256.empty()) to.text("inputs_sha256", provenance.inputs_sha256);
  if (!provenance.fixture_sha256.empty()) to.text("fixture_sha256", provenance.fixture_sha256);
  to.count("seed", provenance.seed);
  to.text("as_built", provenance.as_built);
  to.texts("faults", provenance.faults);
  to.text("command", provenance.command);
  to.texts("libraries", provenance.libraries);
}

}  // namespace

std::vector<Figure> figures(const Record& record) {
  Figures all;
  if (record.placement) add(*record.placement, all);
  if (record.print) add(*record.print, record.trace, all);
  if (record.accuracy) add(*record.accuracy, record, all);
  if (record.calibration) add(*record.calibration, all);
  if (record.registration) add(*record.registration, all);
  if (record.gap) add(*record.gap, all);
  if (record.sag) add(*record.sag, all);
  if (record.collision) add(*record.collision, all);
  if (record.surface) add(*record.surface, all);
  if (record.removal) add(*record.removal, all);
  if (record.engine) add(*record.engine, all);
  add(record.provenance, all);
  return all.take();
}

std::vector<Figure> timing_figures(const Record& record) {
  Figures all;
  if (!record.timing) return {};
  all.section("timing");
  all.put("simulated_s", record.timing->simulated_s);
  all.put("wall_s", record.timing->wall_s);
  if (record.timing->wall_s > 0)
    all.put("real_time_factor", record.timing->simulated_s / record.timing->wall_s);
  if (record.timing->to_first_setpoint_s) all.put("to_first_setpoint_s", *record.timing->to_first_setpoint_s);
  return all.take();
}

}  // namespace understudy::rehearsal
