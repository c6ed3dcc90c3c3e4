#include "calibration/gap_sensor/calibrate_gap_sensor.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "machine/optics_mounting.h"
#include "vision/picture/picture_file.h"

namespace understudy::calibration {
namespace {

constexpr double kImprobable = 6;  // standard deviations of the chi-square
constexpr double kFarOff = 4;      // tolerances: a freedom that is pulled so far is worth a word

void check_machine(const machine::MachineDescription& machine) {
  if (!machine.has_microscope)
    throw InputError({machine.file.string(), 0, 0}, "has no laser and microscope: there is no gap sensor");
  const auto& mounting = machine.tolerances.mounting;
  if (!mounting)
    throw InputError({machine.file.string(), 0, 0},
                     "has no tolerances.mounting: how far laser and microscope may sit from their drawing "
                     "(docs/machine-description.md)");
  if (mounting->position <= 0 || mounting->angle <= 0)
    throw InputError({machine.file.string(), 0, 0},
                     "tolerances.mounting is 0: laser and microscope that sit as drawn need no calibration");
}

vision::DotOptions dot_options(const machine::MachineDescription& machine) {
  const machine::Microscope& m = machine.microscope;
  return vision::dot_options({machine::picture_scale(machine), machine.laser.waist_diameter,
                              machine.laser.wavelength, m.aperture_sine, m.blur_px, m.full_well});
}

std::vector<MeasuredGapPicture> measure(const GapPictureTable& table,
                                        const machine::MachineDescription& machine) {
  const Camera& camera = machine.microscope.camera;
  const vision::DotOptions options = dot_options(machine);
  std::vector<MeasuredGapPicture> pictures;
  for (const GapPicture& row : table.rows) {
    if (row.picture.empty()) continue;
    stop_if_interrupted();
    const Image image = vision::read_picture(row.file);
    if (image.width() != camera.width || image.height() != camera.height)
      throw InputError({table.file, row.line, 0},
                       fmt::format("{} is {} x {} px, the microscope has {} x {} px", row.picture,
                                   image.width(), image.height(), camera.width, camera.height));
    pictures.push_back({row, vision::measure_dot(image, options)});
  }
  return pictures;
}

bool used(const MeasuredGapPicture& picture) { return picture.dot.status == vision::DotStatus::ok; }

void add_dots(const std::vector<MeasuredGapPicture>& pictures, const std::string& file,
              GapSensorProblem& problem) {
  std::vector<GapPicture> seen;
  for (const MeasuredGapPicture& picture : pictures) {
    if (!used(picture)) continue;
    seen.push_back(picture.row);
    problem.dots.push_back(seen_dot(picture.row, picture.dot));
  }
  if (seen.size() == pictures.size()) return;
  const auto first = std::find_if_not(pictures.begin(), pictures.end(), used);
  require_heights(
      seen, file,
      fmt::format("pictures with a dot (line {}: {})", first->row.line, to_string(first->dot.status)));
}

/// A dot that belongs to another height or to no dot at all, or another machine's pictures.
void check_explained(const GapSensorResult& result) {
  const GapSensorFit& fit = result.fit;
  if (!fit.converged)
    throw InputError({result.file, 0, 0},
                     fmt::format("no mounting of laser and microscope of {} explains the dots: are they of "
                                 "this machine?",
                                 result.machine.name));
  const double limit = fit.degrees_of_freedom + kImprobable * std::sqrt(2.0 * fit.degrees_of_freedom);
  if (fit.chi_square <= limit) return;
  const auto worst = std::max_element(fit.residual_sigmas.begin(), fit.residual_sigmas.end());
  const auto index = static_cast<std::size_t>(worst - fit.residual_sigmas.begin());
  std::vector<const MeasuredGapPicture*> seen;
  for (const MeasuredGapPicture& picture : result.pictures)
    if (used(picture)) seen.push_back(&picture);
  throw InputError(
      {result.file, seen[index]->row.line, 0},
      fmt::format("the dot of {} is {:.2f} px ({:.1f} sigma) from where the fitted optics have it, "
                  "the worst of dots that they do not explain: chi-square {:.1f} of {} degrees of "
                  "freedom, at most {:.1f}; look at it: where the nozzle hides a part of the dot, mount the "
                  "microscope so that it sees the whole one, else measure that height again",
                  seen[index]->row.picture, fit.residual_px[index].norm(), *worst, fit.chi_square,
                  fit.degrees_of_freedom, limit));
}

void add_warnings(GapSensorResult& result) {
  for (int i = 0; i < machine::kMountingFreedoms; ++i) {
    const double pulled = result.fit.error[i] / result.tolerance[i];
    if (!(std::abs(pulled) > kFarOff)) continue;
    double si = 1;
    const char* unit = machine::mounting_report_unit(i, si);
    result.warnings.push_back(fmt::format("{} is {:+.1f} {} off the drawing, {:.1f} times its tolerance",
                                          machine::mounting_freedom(i), result.fit.error[i] / si, unit,
                                          std::abs(pulled)));
  }
}

}  // namespace

GapSensorProblem gap_sensor_problem(const machine::MachineDescription& machine) {
  GapSensorProblem problem;
  problem.drawn = machine::drawn_mounting(machine);
  problem.camera = machine.microscope.camera;
  problem.tolerance = machine::mounting_sigmas(*machine.tolerances.mounting);
  problem.speckle_length = machine.laser.waist_diameter;
  problem.waist = machine::drawn_waist(machine);
  problem.blur_px = machine.microscope.blur_px;
  return problem;
}

SeenDot seen_dot(const GapPicture& row, const vision::DotMeasurement& dot) {
  return {row.flat,           row.height,     row.height_sigma, dot.position_px,
          dot.covariance_px2, dot.spread_px2, dot.spread_sigma};
}

void set_gap_sensor(const GapSensorProblem& problem, const GapSensorFit& fit,
                    machine::MachineDescription& machine) {
  machine::GapSensorCalibration record;
  record.drawn = problem.drawn;
  record.pictures = static_cast<int>(problem.dots.size());
  record.covariance = fit.covariance;
  machine::set_mounting(fit.mounting, machine.laser, machine.microscope);
  machine.laser.waist_diameter = problem.waist;
  if (fit.waist > 0) {
    record.waist = machine::MeasuredWaist{problem.waist, fit.waist_sigma};
    machine.laser.waist_diameter = fit.waist;
  }
  machine.gap_sensor = record;
}

GapSensorResult calibrate_gap_sensor(const std::string& file, const machine::MachineDescription& machine) {
  check_machine(machine);
  const GapPictureTable table = read_gap_pictures(file);
  GapSensorProblem problem = gap_sensor_problem(machine);
  problem.slopes = table.slopes;
  problem.known = table.known;
  GapSensorResult result;
  result.machine = machine;
  result.file = file;
  result.known = table.known;
  result.tolerance = problem.tolerance;
  result.pictures = measure(table, machine);
  add_dots(result.pictures, file, problem);
  result.fit = fit_gap_sensor(problem);
  check_explained(result);
  add_warnings(result);
  set_gap_sensor(problem, result.fit, result.machine);
  result.machine.gap_sensor->measurements = file;
  result.machine.gap_sensor->measurements_sha256 = table.sha256;
  return result;
}

}  // namespace understudy::calibration
