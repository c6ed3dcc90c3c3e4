#include "report/calibration/identify_summary.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using calibration::AxisFit;
using calibration::AxisParameter;
using calibration::Identification;
using calibration::IdentifiedAxis;
using Json = nlohmann::ordered_json;

double stable(double value) { return stable_number(value, "identify"); }

/// A parameter in the unit that it is shown in.
struct Shown {
  const char* name;
  std::string unit;
  double value = 0, sigma = 0;
  bool told = false;
};

double length_unit(const IdentifiedAxis& axis) { return axis.angle ? kDegree / 60 : kMicrometre; }
const char* length_word(const IdentifiedAxis& axis) { return axis.angle ? "arcmin" : "um"; }

std::vector<Shown> shown_of(const IdentifiedAxis& axis) {
  std::vector<Shown> all;
  const auto add = [&](const AxisFit& fit, const char* name, AxisParameter p, const std::string& unit_name,
                       double unit) {
    all.push_back({name, unit_name, fit.of(p) / unit, fit.sigma(p) / unit, fit.told(p)});
  };
  const double length = length_unit(axis);
  if (axis.load) {
    add(*axis.load, "zero", AxisParameter::zero, length_word(axis), length);
    add(*axis.load, "play", AxisParameter::play, length_word(axis), length);
    add(*axis.load, "lead", AxisParameter::scale, "permille", 1e-3);
    const double sine = axis.load->of(AxisParameter::sine), cosine = axis.load->of(AxisParameter::cosine);
    all.push_back(
        {"periodic", length_word(axis), std::hypot(sine, cosine) / length,
         std::hypot(axis.load->sigma(AxisParameter::sine), axis.load->sigma(AxisParameter::cosine)) /
             std::sqrt(2.0) / length,
         axis.load->told(AxisParameter::sine)});
  }
  add(axis.load ? *axis.load : axis.drive, "lag", AxisParameter::lag, "ms", 1e-3);
  return all;
}

Json fit_json(const AxisFit& fit) {
  Json json{{"rows", fit.rows},
            {"left_out", fit.left_out},
            {"upper_side", fit.upper},
            {"side_changes", fit.side_changes},
            {"chi_square", stable(fit.chi_square)},
            {"degrees_of_freedom", fit.degrees_of_freedom},
            {"covariance_si", Json::array()}};
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) json["covariance_si"].push_back(stable(fit.covariance(i, j)));
  return json;
}

std::string seen_text(const IdentifiedAxis& axis) {
  if (!axis.load) return "";
  const AxisFit& fit = *axis.load;
  return fmt::format("   {} rows, {} side changes, chi-square {:.2f} a degree, residual {:.2f} {} RMS",
                     fit.rows, fit.side_changes,
                     fit.degrees_of_freedom > 0 ? fit.chi_square / fit.degrees_of_freedom : 0,
                     fit.residual_rms / length_unit(axis), length_word(axis));
}

}  // namespace

std::string identify_text(const Identification& found) {
  std::string out = fmt::format("{} from {}, {:.1f} s\n", found.machine.name, found.record, found.seconds);
  for (const IdentifiedAxis& axis : found.axes) {
    out += fmt::format("  {:4}", axis.name);
    for (const Shown& p : shown_of(axis))
      out += p.told ? fmt::format("  {} {:.3f} +- {:.3f} {}", p.name, p.value, p.sigma, p.unit)
                    : fmt::format("  {} not told", p.name);
    out += "\n      " + seen_text(axis) + "\n";
  }
  for (const std::string& words : found.untold) out += "  not told, left as it was: " + words + "\n";
  for (const std::string& words : found.warnings) out += "  warning: " + words + "\n";
  return out;
}

std::string identify_json(const Identification& found) {
  Json json{{"schema", "understudy.identify/1"},
            {"machine", found.machine.name},
            {"record", found.record},
            {"record_sha256", found.record_sha256},
            {"seconds", stable(found.seconds)},
            {"zero_offsets_written", found.geometry_written},
            {"axes", Json::array()},
            {"not_told", found.untold},
            {"warnings", found.warnings}};
  for (const IdentifiedAxis& axis : found.axes) {
    Json object{{"axis", axis.name}};
    for (const Shown& p : shown_of(axis)) {
      if (!p.told) continue;
      object[fmt::format("{}_{}", p.name, p.unit)] = stable(p.value);
      object[fmt::format("{}_sigma_{}", p.name, p.unit)] = stable(p.sigma);
    }
    object["fit"] = fit_json(axis.load ? *axis.load : axis.drive);
    object["measured"] = axis.load ? "load" : "drive";
    json["axes"].push_back(object);
  }
  json["covariance_order"] =
      "zero, play, scale, lag, sine, cosine: the lower triangle row by row, in m or rad";
  json["command"] = found.command;
  json["version"] = kVersion;
  return to_text(json, 2) + "\n";
}

}  // namespace understudy::report
