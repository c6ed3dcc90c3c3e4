#include "report/calibration/gap_sensor_summary.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "control/gap/gap_reading.h"
#include "control/gap/sensor_uncertainty.h"
#include "core/units.h"
#include "core/version.h"
#include "machine/optics_mounting.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using calibration::GapSensorResult;

std::array<double, 4> shown_gaps(const machine::GapLimits& limits) {
  return {limits.accepted_min, limits.aim, limits.accepted_max, limits.standoff};
}

machine::MachineDescription as_drawn(const GapSensorResult& result) {
  machine::MachineDescription drawn = result.machine;
  machine::set_mounting(result.machine.gap_sensor->drawn, drawn.laser, drawn.microscope);
  drawn.gap_sensor->covariance = result.tolerance.array().square().matrix().asDiagonal();
  return drawn;
}

std::string head(const GapSensorResult& result) {
  const auto& fit = result.fit;
  std::vector<calibration::GapPicture> rows;
  for (const auto& picture : result.pictures)
    if (picture.dot.status == vision::DotStatus::ok) rows.push_back(picture.row);
  const auto spread = calibration::height_spread(rows);
  return fmt::format(
      "gap sensor of {}: {} of {} pictures at {} heights over {:.2f} mm, flats: {}, known gaps: {}\n"
      "chi-square {:.1f} of {} degrees of freedom; the worst dot is {:.1f} sigma off\n",
      result.machine.name, rows.size(), result.pictures.size(), spread.heights, to_mm(spread.spread),
      fit.zero.size(), result.known.size(), fit.chi_square, fit.degrees_of_freedom,
      *std::max_element(fit.residual_sigmas.begin(), fit.residual_sigmas.end()));
}

std::string freedoms(const GapSensorResult& result) {
  std::string out = "\n                     off the drawing    1 sigma   tolerance\n";
  std::vector<std::string> unshown;
  for (int i = 0; i < machine::kMountingFreedoms; ++i) {
    double si = 1;
    const char* unit = machine::mounting_report_unit(i, si);
    const double sigma = std::sqrt(result.fit.covariance(i, i));
    out += fmt::format("  {:<16} {:>+12.2f} {:<8} {:>9.2f} {:>11.2f}\n", machine::mounting_freedom(i),
                       result.fit.error[i] / si, unit, sigma / si, result.tolerance[i] / si);
    if (sigma > calibration::kUnshown * result.tolerance[i]) unshown.push_back(machine::mounting_freedom(i));
  }
  if (!unshown.empty())
    out += fmt::format("the pictures do not show these, which keep their tolerance: {}\n",
                       fmt::join(unshown, ", "));
  return out;
}

std::string beam(const GapSensorResult& result) {
  if (!result.machine.gap_sensor->waist) return "";
  const machine::MeasuredWaist& waist = *result.machine.gap_sensor->waist;
  return fmt::format("the beam is {:.1f} um wide, 1 sigma {:.1f} um; drawn: {:.1f} um\n",
                     to_um(result.machine.laser.waist_diameter), to_um(waist.sigma), to_um(waist.drawn));
}

std::string readings(const GapSensorResult& result) {
  const machine::GapLimits& limits = result.machine.gap;
  std::string out = "\nover a flat    read as drawn    1 sigma as drawn    1 sigma calibrated\n";
  for (const double gap : shown_gaps(limits)) {
    const GapReadingChange change = gap_reading_change(result, gap);
    out += fmt::format("  {:.3f} mm   {:>10.3f} mm       {:>10.1f} um         {:>10.1f} um\n", to_mm(gap),
                       to_mm(change.drawn), to_um(change.drawn_sigma), to_um(change.sigma));
  }
  const auto aim = control::safe_aim(result.machine, {}, limits.aim);
  if (!aim.fits)
    out += control::too_uncertain(limits, aim.sigma) + ": gap control would stop\n";
  else if (aim.gap != limits.aim)
    out += fmt::format("gap control aims at {:.3f} mm instead of {:.3f} mm, for 3 sigma to fit\n",
                       to_mm(aim.gap), to_mm(limits.aim));
  return out;
}

}  // namespace

GapReadingChange gap_reading_change(const GapSensorResult& result, double gap) {
  const machine::MachineDescription drawn = as_drawn(result);
  GapReadingChange change{gap, std::nan(""), control::calibration_sigma(drawn, {}, gap),
                          control::calibration_sigma(result.machine, {}, gap)};
  vision::DotMeasurement dot;
  control::GapReading reading;
  if (control::dot_pixel(result.machine.laser, result.machine.microscope, {}, gap, dot.position_px) &&
      control::read_gap(drawn, {}, dot, reading))
    change.drawn = reading.gap;
  return change;
}

std::string gap_sensor_json(const GapSensorResult& result, const std::string& command) {
  const auto& fit = result.fit;
  Json document{{"schema", "understudy.gap-sensor/1"},
                {"machine", result.machine.name},
                {"table", result.file},
                {"pictures", result.pictures.size()},
                {"pictures_used", fit.residual_sigmas.size()},
                {"known_gaps", result.known.size()},
                {"chi_square", fit.chi_square},
                {"degrees_of_freedom", fit.degrees_of_freedom},
                {"mounting", Json::array()}};
  for (int i = 0; i < machine::kMountingFreedoms; ++i) {
    double si = 1;
    const char* unit = machine::mounting_report_unit(i, si);
    const double sigma = std::sqrt(fit.covariance(i, i));
    document["mounting"].push_back({{"freedom", machine::mounting_freedom(i)},
                                    {"unit", unit},
                                    {"off_the_drawing", fit.error[i] / si},
                                    {"sigma", sigma / si},
                                    {"tolerance", result.tolerance[i] / si},
                                    {"shown", sigma <= calibration::kUnshown * result.tolerance[i]}});
  }
  if (const auto& waist = result.machine.gap_sensor->waist)
    document["beam"] = {{"width_um", to_um(result.machine.laser.waist_diameter)},
                        {"sigma_um", to_um(waist->sigma)},
                        {"drawn_um", to_um(waist->drawn)}};
  document["readings"] = Json::array();
  for (const double gap : shown_gaps(result.machine.gap)) {
    const GapReadingChange change = gap_reading_change(result, gap);
    Json reading{{"gap_mm", to_mm(gap)}};
    if (std::isfinite(change.drawn)) reading["read_as_drawn_mm"] = to_mm(change.drawn);
    reading["sigma_as_drawn_um"] = to_um(change.drawn_sigma);
    reading["sigma_um"] = to_um(change.sigma);
    document["readings"].push_back(reading);
  }
  document["warnings"] = result.warnings;
  document["provenance"] = {{"version", kVersion}, {"command", command}};
  return to_text(document, 2) + "\n";
}

std::string gap_sensor_text(const GapSensorResult& result) {
  std::string out = head(result) + freedoms(result) + beam(result) + readings(result);
  for (const std::string& warning : result.warnings) out += "warning: " + warning + "\n";
  return out;
}

}  // namespace understudy::report
