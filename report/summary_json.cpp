#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "report/report.h"
#include "report/summary_value.h"

namespace understudy::rehearsal {
namespace {

using Json = nlohmann::ordered_json;

void put(Json& object, const char* key, double value) { object[key] = stable_number(value, key); }

Json finding_value(const Finding& finding) {
  Json object;
  object["kind"] = finding.kind;
  object["severity"] = finding.severity == Severity::error ? "error" : "warning";
  if (finding.gcode_line > 0) object["gcode_line"] = finding.gcode_line;
  put(object, "time_s", finding.time_s);
  put(object, "value", finding.value);
  put(object, "limit", finding.limit);
  object["unit"] = finding.unit;
  object["message"] = finding.message;
  return object;
}

Json print_value(const PrintFigures& print) {
  Json object;
  put(object, "duration_s", print.duration_s);
  object["moves"] = print.moves;
  put(object, "extruded_mm", print.extruded_mm);
  put(object, "deposited_mm", print.deposited_mm);
  put(object, "travel_mm", print.travel_mm);
  return object;
}

Json accuracy_value(const AccuracyFigures& accuracy) {
  Json object;
  put(object, "tip_rms_um", accuracy.tip_rms_um);
  put(object, "tip_p95_um", accuracy.tip_p95_um);
  put(object, "tip_max_um", accuracy.tip_max_um);
  put(object, "orientation_max_mrad", accuracy.orientation_max_mrad);
  put(object, "open_loop_tip_max_um", accuracy.open_loop_tip_max_um);
  return object;
}

Json calibration_value(const CalibrationFigures& calibration) {
  Json object;
  object["machine_before"] = calibration.machine_before;
  object["machine_after"] = calibration.machine_after;
  if (!calibration.not_run_before.empty()) object["not_run_before"] = calibration.not_run_before;
  const auto pair = [&](const std::string& name, const std::string& unit, double AccuracyFigures::*figure) {
    if (calibration.before) put(object, (name + "_before_" + unit).c_str(), *calibration.before.*figure);
    put(object, (name + "_after_" + unit).c_str(), calibration.after.*figure);
  };
  pair("tip_rms", "um", &AccuracyFigures::tip_rms_um);
  pair("tip_p95", "um", &AccuracyFigures::tip_p95_um);
  pair("tip_max", "um", &AccuracyFigures::tip_max_um);
  pair("orientation_max", "mrad", &AccuracyFigures::orientation_max_mrad);
  return object;
}

Json gap_value(const GapFigures& gap) {
  Json object;
  put(object, "commanded_mm", gap.commanded_mm);
  if (gap.open_loop_start_mm) put(object, "open_loop_start_mm", *gap.open_loop_start_mm);
  put(object, "start_mm", gap.start_mm);
  put(object, "path_min_mm", gap.path_min_mm);
  put(object, "path_mean_mm", gap.path_mean_mm);
  put(object, "path_max_mm", gap.path_max_mm);
  put(object, "in_band_fraction", gap.in_band_fraction);
  object["frames"] = gap.frames;
  return object;
}

Json collision_value(const CollisionFigures& collision) {
  Json object;
  put(object, "min_clearance_mm", collision.min_clearance_mm);
  object["checks"] = collision.checks;
  object["pairs"] = collision.pairs;
  return object;
}

Json sag_value(const SagFigures& sag) {
  Json object;
  put(object, "max_um", sag.max_um);
  object["strands"] = sag.strands;
  put(object, "unsupported_mm", sag.unsupported_mm);
  return object;
}

Json surface_value(const SurfaceFigures& surface) {
  Json object;
  if (surface.ra_um) put(object, "ra_um", *surface.ra_um);
  if (surface.rz_um) put(object, "rz_um", *surface.rz_um);
  if (surface.deviation_p95_um) put(object, "deviation_p95_um", *surface.deviation_p95_um);
  return object;
}

Json engine_value(const EngineFigures& engine) {
  Json object;
  object["name"] = engine.name;
  object["version"] = engine.version;
  put(object, "timestep_s", engine.timestep_s);
  object["steps"] = engine.steps;
  put(object, "real_time_factor", engine.real_time_factor);
  put(object, "closure_max_um", engine.closure_max_um);
  return object;
}

Json provenance_value(const Provenance& provenance) {
  Json object;
  object["version"] = provenance.version;
  object["machine_sha256"] = provenance.machine_sha256;
  if (!provenance.machine_before_sha256.empty())
    object["machine_before_sha256"] = provenance.machine_before_sha256;
  object["program_sha256"] = provenance.program_sha256;
  object["seed"] = provenance.seed;
  object["as_built"] = provenance.as_built;
  if (!provenance.faults.empty()) object["faults"] = provenance.faults;
  object["command"] = provenance.command;
  return object;
}

}  // namespace

double stable_number(double value, const char* what, int digits) {
  if (!std::isfinite(value)) throw std::logic_error(std::string(what) + " is not a finite number");
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::strtod(text, nullptr) + 0.0;  // adding 0 turns -0 into 0
}

std::string to_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json summary_value(const Record& record) {
  Json summary;
  summary["schema"] = "understudy.rehearsal/1";
  summary["verdict"] = record.go ? "go" : "no-go";
  summary["findings"] = Json::array();
  for (const Finding& finding : record.findings) summary["findings"].push_back(finding_value(finding));
  if (record.print) summary["print"] = print_value(*record.print);
  if (record.accuracy) summary["accuracy"] = accuracy_value(*record.accuracy);
  if (record.calibration) summary["calibration"] = calibration_value(*record.calibration);
  if (record.gap) summary["gap"] = gap_value(*record.gap);
  if (record.sag) summary["sag"] = sag_value(*record.sag);
  if (record.collision) summary["collision"] = collision_value(*record.collision);
  if (record.surface) summary["surface"] = surface_value(*record.surface);
  if (record.engine) summary["engine"] = engine_value(*record.engine);
  summary["provenance"] = provenance_value(record.provenance);
  return summary;
}

std::string summary_json(const Record& record) { return to_text(summary_value(record), 2) + "\n"; }

}  // namespace understudy::rehearsal
