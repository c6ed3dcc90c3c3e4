#include "report/calibration/calibration_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"

namespace understudy::report {
namespace {

using namespace calibration;
using nlohmann::ordered_json;

/// Six significant digits; a number that is none is absent.
ordered_json number(double v) {
  if (!std::isfinite(v)) return nullptr;
  return stable_number(v, "calibration");
}

std::size_t used_poses(const MachineCalibration& result) {
  return static_cast<std::size_t>(
      std::count_if(result.poses.begin(), result.poses.end(), [](const PoseResidual& p) { return p.used; }));
}

double turn_rms(const MachineCalibration& result, bool before) {
  double sum = 0;
  for (const PoseResidual& p : result.poses)
    if (const auto turn = (before ? p.before : p.after).tail<3>(); p.used && turn.allFinite())
      sum += turn.squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, used_poses(result))));
}

ordered_json pose_value(const PoseResidual& p) {
  ordered_json value{{"line", p.line}, {"used", p.used}};
  const auto list = [](const Twist& e) {
    ordered_json six = ordered_json::array();
    for (Eigen::Index i = 0; i < 3; ++i) six.push_back(number(to_um(e[i])));
    for (Eigen::Index i = 3; i < 6; ++i) six.push_back(number(1e3 * e[i]));
    return six;
  };
  value["before"] = list(p.before);
  value["after"] = list(p.after);
  if (!p.strut.empty()) {
    value["strut_um"] = ordered_json::array();
    for (const double f : p.strut) value["strut_um"].push_back(number(to_um(f)));
  }
  return value;
}

ordered_json tip_value(const TipMap& tip) {
  return {{"sigma_median_um", number(to_um(tip.median))},
          {"sigma_rms_um", number(to_um(tip.rms))},
          {"sigma_worst_um", number(to_um(tip.worst))},
          {"before_median_um", number(to_um(tip.moved_median))},
          {"before_worst_um", number(to_um(tip.moved_worst))},
          {"poses", tip.poses}};
}

std::string part_lines(const std::vector<PartReport>& parts, const char* of) {
  std::string out;
  for (const PartReport& part : parts) {
    const bool turn = part.name == "turn";
    const double unit = turn ? 1e3 : 1e6;
    out += fmt::format("  {}{:<10} {:5} values {:10.3f} {} RMS before, {:.3f} after", of, part.name,
                       part.values, unit * part.before, turn ? "mrad" : "um", unit * part.after);
    if (part.added > 0)
      out += fmt::format(", noise {} {:.3f}", part.told ? "added" : "found", unit * part.added);
    out += "\n";
  }
  return out;
}

/// "tracker.csv:17: position 5.02 mm, 98.1 sigma"
std::string spoiled_text(const SpoiledLine& row) {
  std::string off;
  if (row.length > 0) off += fmt::format(" {:.3f} mm,", to_mm(row.length));
  if (row.turn > 0) off += fmt::format(" {:.3f} deg,", to_deg(row.turn));
  return fmt::format("{}:{}: {}{} {:.1f} sigma", row.file, row.line, row.kind, off, row.sigmas);
}

/// A line each, of many the first; summary.json has all.
std::string few_lines(const char* what, const std::vector<std::string>& list) {
  constexpr std::size_t kShown = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, list.size()); ++i)
    out += fmt::format("  {}: {}\n", what, list[i]);
  if (list.size() > kShown)
    out += fmt::format("  {}: {} more, in summary.json of --report\n", what, list.size() - kShown);
  return out;
}

/// Of rows of any kind.
std::string rows_text(const MachineCalibration& result) {
  std::string out = part_lines(result.parts, "") + part_lines(result.compared, "not fitted: ");
  if (result.compared_files.size() > 1)
    for (const ComparedFile& file : result.compared_files)
      out += fmt::format("  not fitted, {}:\n", file.file) + part_lines(file.parts, "  ");
  out += fmt::format("  chi-square {:.1f} for {} degrees of freedom\n", result.chi_square,
                     result.degrees_of_freedom);
  if (result.shared > 0)
    out += fmt::format(
        "  rows of one pose have {:.0f} % of their errors in common, which the uncertainties hold\n",
        100 * result.shared);
  for (const FoundNumber& number : result.found)
    out += fmt::format("  {:<28} {:12.4f} {} (1 sigma {:.4f})\n", number.name,
                       number.angle ? to_deg(number.value) : to_mm(number.value), number.angle ? "deg" : "mm",
                       number.angle ? to_deg(number.sigma) : to_mm(number.sigma));
  for (const TargetSigma& target : result.target_sigmas)
    out += fmt::format("  uncertainty of {:<17} {:9.1f} um, 1 sigma about the base (median of its rows)\n",
                       target.name, to_um(target.median));
  if (result.tip.poses > 0)
    out += fmt::format("  tip uncertainty left, 1 sigma   {:9.1f} um median, {:.1f} um worst ({} poses)\n",
                       to_um(result.tip.median), to_um(result.tip.worst), result.tip.poses);
  out += fmt::format("  {} redundant parameters were left as they are\n", result.redundant.size());
  std::vector<std::string> spoiled;
  for (const SpoiledLine& row : result.spoiled) spoiled.push_back(spoiled_text(row));
  out += few_lines("hardly told by these rows, and left near its drawing", result.untold);
  out += few_lines("hardly told together, and left near their drawing", result.untold_together);
  out += few_lines("left out, off from what the other rows say", spoiled);
  for (const std::string& note : result.notes) out += "  " + note + "\n";
  for (const std::string& warning : result.warnings) out += "  warning: " + warning + "\n";
  return out;
}

ordered_json part_values(const std::vector<PartReport>& parts) {
  ordered_json list = ordered_json::array();
  for (const PartReport& part : parts) {
    const bool turn = part.name == "turn";
    const std::string unit = turn ? "_mrad" : "_um";
    const double factor = turn ? 1e3 : 1e6;
    list.push_back({{"part", part.name},
                    {"values", part.values},
                    {"rms_before" + unit, number(factor * part.before)},
                    {"rms_after" + unit, number(factor * part.after)},
                    {"noise_told", part.told},
                    {"noise_added" + unit, number(factor * part.added)}});
  }
  return list;
}

}  // namespace

std::string calibration_text(const MachineCalibration& result) {
  std::string out =
      fmt::format("{}: {} of {} poses, {} parameters by {}\n", result.machine.name, used_poses(result),
                  result.poses.size(), result.parameters.size(), result.estimator);
  if (!result.parts.empty()) return out + rows_text(result);
  out += fmt::format("  residual of the measured tips   {:9.1f} um RMS before, {:.1f} um after\n",
                     to_um(residual_rms(result, true)), to_um(residual_rms(result, false)));
  out += fmt::format("  residual of the orientations    {:9.2f} mrad RMS before, {:.2f} mrad after\n",
                     1e3 * turn_rms(result, true), 1e3 * turn_rms(result, false));
  if (result.degrees_of_freedom > 0)
    out += fmt::format("  chi-square                      {:9.1f} for {} degrees of freedom\n",
                       result.chi_square, result.degrees_of_freedom);
  else
    out += "  chi-square                      no degree of freedom is left to test the model by\n";
  out += fmt::format(
      "  tip error over the work space   {:9.1f} um median before (worst {:.1f}), as told by the "
      "new model\n",
      to_um(result.tip.moved_median), to_um(result.tip.moved_worst));
  if (result.tip.poses > 0)
    out += fmt::format("  tip uncertainty left, 1 sigma   {:9.1f} um median, {:.1f} um worst ({} poses)\n",
                       to_um(result.tip.median), to_um(result.tip.worst), result.tip.poses);
  else
    out += "  tip uncertainty left            not known\n";
  if (const auto& frame = result.frame)
    out += fmt::format(
        "  of which the measuring frame    {:9.1f} um, {:.3f} mrad, {:.3f} permille, alike in all poses\n",
        to_um(frame->position), 1e3 * frame->rotation, 1e3 * frame->strain);
  if (!result.redundant.empty())
    out += fmt::format("  {} redundant parameters were left as they are\n", result.redundant.size());
  for (const ParameterLine& line : result.parameters)
    if (line.name.starts_with("play") || line.name == "deviation")
      out +=
          fmt::format("  {:<31} {:9.2f} {} (1 sigma {:.2f})\n", line.name, line.after, line.unit, line.sigma);
  for (const std::string& warning : result.warnings) out += "  warning: " + warning + "\n";
  return out;
}

std::string calibration_json(const MachineCalibration& result) {
  ordered_json value{{"schema", "understudy.calibration/1"},
                     {"machine", result.machine.name},
                     {"mechanism", result.machine.mechanism},
                     {"estimator", result.estimator}};
  value["poses"] = {{"measured", result.poses.size()}, {"used", used_poses(result)}};
  value["noise"] = {{"told", result.noise_given}};
  if (!result.noise_given) {
    value["noise"]["position_um"] = number(to_um(result.noise.position));
    value["noise"]["rotation_mrad"] = number(1e3 * result.noise.rotation);
  }
  if (const auto& frame = result.frame)
    value["frame"] = {{"position_um", number(to_um(frame->position))},
                      {"rotation_mrad", number(1e3 * frame->rotation)},
                      {"strain_permille", number(1e3 * frame->strain)}};
  value["residual"] = {{"tip_rms_before_um", number(to_um(residual_rms(result, true)))},
                       {"tip_rms_after_um", number(to_um(residual_rms(result, false)))},
                       {"orientation_rms_before_mrad", number(1e3 * turn_rms(result, true))},
                       {"orientation_rms_after_mrad", number(1e3 * turn_rms(result, false))},
                       {"chi_square", number(result.chi_square)},
                       {"degrees_of_freedom", result.degrees_of_freedom},
                       {"iterations", result.iterations}};
  value["tip"] = tip_value(result.tip);
  value["correlation_max"] = number(result.correlation_max);
  value["parameters"] = ordered_json::array();
  for (const ParameterLine& p : result.parameters)
    value["parameters"].push_back({{"name", p.name},
                                   {"unit", p.unit},
                                   {"before", number(p.before)},
                                   {"after", number(p.after)},
                                   {"sigma", number(p.sigma)}});
  if (!result.redundant.empty()) value["redundant"] = result.redundant;
  if (!result.parts.empty()) {
    value["targets"] = ordered_json::array();
    for (const TargetSigma& target : result.target_sigmas)
      value["targets"].push_back({{"name", target.name}, {"sigma_median_um", number(to_um(target.median))}});
    value["untold"] = result.untold;
    value["untold_together"] = result.untold_together;
    value["spoiled"] = ordered_json::array();
    for (const SpoiledLine& row : result.spoiled)
      value["spoiled"].push_back({{"file", row.file},
                                  {"line", row.line},
                                  {"kind", row.kind},
                                  {"off_mm", number(to_mm(row.length))},
                                  {"off_deg", number(to_deg(row.turn))},
                                  {"sigmas", number(row.sigmas)}});
    value["parts"] = part_values(result.parts);
    if (result.shared > 0) value["shared_in_one_pose"] = number(result.shared);
    if (!result.compared.empty()) value["not_fitted"] = part_values(result.compared);
    if (result.compared_files.size() > 1) {
      value["not_fitted_by_file"] = ordered_json::array();
      for (const ComparedFile& file : result.compared_files)
        value["not_fitted_by_file"].push_back({{"file", file.file}, {"parts", part_values(file.parts)}});
    }
    value["found"] = ordered_json::array();
    for (const FoundNumber& f : result.found) {
      const std::string unit = f.angle ? "_deg" : "_mm";
      const double factor = 1 / (f.angle ? kDegree : kMillimetre);
      value["found"].push_back({{"name", f.name},
                                {"value" + unit, number(factor * f.value)},
                                {"sigma" + unit, number(factor * f.sigma)}});
    }
  }
  value["samples"] = ordered_json::array();
  for (const PoseResidual& p : result.poses) value["samples"].push_back(pose_value(p));
  value["warnings"] = result.warnings;
  value["provenance"] = {{"version", kVersion},
                         {"machine_sha256", result.machine.sha256},
                         {"measurements", result.machine.calibration->measurements},
                         {"measurements_sha256", result.machine.calibration->measurements_sha256},
                         {"command", result.command}};
  return value.dump(1) + "\n";
}

}  // namespace understudy::report
