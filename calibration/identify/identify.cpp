#include "calibration/identify/identify.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "calibration/calibrated.h"
#include "calibration/identify/axis_rows.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "machine/built_tolerances.h"
#include "machine/load_encoders.h"

namespace understudy::calibration {
namespace {

constexpr double kShortest = 1;               // [s]
const double kOfCount = 1 / std::sqrt(12.0);  // 1 sigma of what rounding to counts leaves

/// Of rounding, by the encoder and by the motor's steps.
double noise_of(const machine::Drive& drive, double count) {
  return kOfCount * std::hypot(count, drive.step());
}

double described_play(const machine::MachineDescription& machine, std::size_t axis) {
  return machine.visit(
      [](const machine::HexapodModel& hexapod) { return hexapod.play.screw_nut + hexapod.play.ball_joint; },
      [&](const machine::ChainModel& chain) { return chain.play[axis]; });
}

void tell_untold(const IdentifiedAxis& axis, std::vector<std::string>& untold) {
  constexpr std::array kOfLoad{AxisParameter::zero, AxisParameter::play, AxisParameter::scale,
                               AxisParameter::sine};
  constexpr std::array kWords{"zero offset", "play", "lead", "periodic error"};
  for (std::size_t k = 0; k < kOfLoad.size(); ++k) {
    const auto which = static_cast<std::size_t>(kOfLoad[k]);
    const std::string why =
        axis.load ? axis.load->untold[which] : "the record has no encoder behind the play of this axis";
    if (!why.empty()) untold.emplace_back(fmt::format("{} {}: {}", axis.name, kWords[k], why));
  }
  const AxisFit& moved = axis.load ? *axis.load : axis.drive;
  if (!moved.told(AxisParameter::lag))
    untold.emplace_back(fmt::format("{} drive lag: {}", axis.name,
                                    moved.untold[static_cast<std::size_t>(AxisParameter::lag)]));
}

void warn_of_fit(const IdentifiedAxis& axis, std::vector<std::string>& warnings) {
  if (!axis.load || axis.load->rows == 0) return;
  const AxisFit& fit = *axis.load;
  // Too small a chi-square is no fault: rounding is less than its sigma where axes move slowly.
  const bool large = fit.chi_square > fit.degrees_of_freedom;
  if (const std::string misfit = misfit_warning(fit.chi_square, fit.degrees_of_freedom,
                                                "stiffness, heat, joints that are not where they are drawn");
      large && !misfit.empty())
    warnings.emplace_back(axis.name + ": " + misfit);
  if (fit.left_out > fit.rows / 10)
    warnings.emplace_back(fmt::format("{}: {} of {} rows lie between both ends of its play and are left out",
                                      axis.name, fit.left_out, fit.rows));
}

AxisFit fitted(const std::vector<AxisRow>& rows, const machine::Drive& drive, double noise) {
  AxisFitOptions options;
  options.noise = noise;
  options.turn = drive.lead;
  return fit_axis(rows, options);
}

std::vector<IdentifiedAxis> fit_all(const machine::RecordedMotion& motion, const IdentifyRequest& request,
                                    const machine::MachineDescription& machine) {
  const machine::LoadEncoderCounts counts = machine::load_encoder_counts(machine.file.string());
  const AxisSeries series = axis_series(motion, machine, counts);
  const auto mechanism = machine.make_mechanism();
  std::vector<IdentifiedAxis> axes;
  for (std::size_t i = 0; i < series.drives.size(); ++i) {
    const machine::Drive& drive = machine.drives[i];
    IdentifiedAxis axis;
    axis.name = mechanism->axis_name(static_cast<int>(i));
    axis.angle = mechanism->axis_is_angle(static_cast<int>(i));
    axis.play_before = described_play(machine, i);
    axis.drive = fitted(series.drives[i], drive, noise_of(drive, drive.step()));
    axis.noise = (axis.angle ? request.noise_angle : request.noise_length)
                     .value_or(noise_of(drive, counts.of(axis.angle)));
    if (!series.load.empty()) axis.load = fitted(series.load[i], drive, axis.noise);
    axes.push_back(std::move(axis));
  }
  return axes;
}

/// A zero whose play was seen on one side only may be off by half of it.
double zero_variance(const IdentifiedAxis& axis) {
  const double sigma = axis.load->sigma(AxisParameter::zero);
  const double side = axis.load->told(AxisParameter::play) ? 0 : 0.5 * axis.play_before;
  return sigma * sigma + side * side;
}

constexpr Eigen::Index kOfStrut = 7;  // rows of the covariance: b_i, a_i, l_i0
constexpr Eigen::Index kFirstPlay = kOfStrut * kinematics::kStruts + 1;
constexpr Eigen::Index kFirstLead = kFirstPlay + kinematics::kStruts;

/// What is found of strut `i`, in the places of the calibrated machine file.
void store_strut(const IdentifiedAxis& axis, std::size_t i, const machine::BuiltTolerances& tolerances,
                 Identification& found) {
  const auto strut = static_cast<Eigen::Index>(i);
  machine::CalibratedParameters& stored = found.stored;
  const auto parameter = [&](AxisParameter p, double before, double sigma_before, Eigen::Index row) {
    const bool told = axis.load->told(p);
    const double sigma = told ? axis.load->sigma(p) : sigma_before;
    stored.covariance(row, row) = sigma * sigma;
    return told ? axis.load->of(p) : before;
  };
  (*stored.play)[i] = parameter(AxisParameter::play, axis.play_before, tolerances.play * axis.play_before,
                                kFirstPlay + strut);
  (*stored.lead)[i] = parameter(AxisParameter::scale, 0, tolerances.lead, kFirstLead + strut);
  const bool both = axis.load->told(AxisParameter::zero);
  if (!found.geometry_written || !both) return;
  found.machine.hexapod().geometry.length_offset[i] += axis.load->of(AxisParameter::zero);
  const Eigen::Index zero = kOfStrut * strut + 6;
  stored.covariance(zero, zero) = zero_variance(axis);
  // A length offset and the lead pull on the same rows.
  const auto at = [](AxisParameter p) { return static_cast<Eigen::Index>(p); };
  const double shared = axis.load->covariance(at(AxisParameter::zero), at(AxisParameter::scale));
  stored.covariance(zero, kFirstLead + strut) = stored.covariance(kFirstLead + strut, zero) = shared;
}

void store_hexapod(const machine::CalibratedParameters& before, Identification& found) {
  const machine::BuiltTolerances tolerances = machine::load_built_tolerances(found.machine.file.string());
  found.geometry_written = !found.machine.calibration;
  found.stored.play.emplace();
  found.stored.lead.emplace();
  found.stored.covariance =
      Eigen::MatrixXd::Zero(kFirstLead + kinematics::kStruts, kFirstLead + kinematics::kStruts);
  if (before.covariance.size() > 0)
    found.stored.covariance.topLeftCorner(kFirstPlay, kFirstPlay) =
        before.covariance.topLeftCorner(kFirstPlay, kFirstPlay);
  for (std::size_t i = 0; i < found.axes.size(); ++i) store_strut(found.axes[i], i, tolerances, found);
  if (!found.geometry_written) {
    found.warnings.emplace_back(
        "the machine file has a calibration already: its geometry, zero offsets with it, stays as it is");
    return;
  }
  int rows = 0;
  for (const IdentifiedAxis& axis : found.axes) rows = std::max(rows, axis.load->rows);
  found.machine.calibration = {"identify", std::filesystem::path(found.record).filename().string(),
                               found.record_sha256, std::clamp(rows, 1, 1000000)};
}

void warn_of_record(const machine::RecordedMotion& motion, std::vector<std::string>& warnings) {
  if (!motion.whole) warnings.emplace_back("the record was cut short: used up to its last whole entry");
  if (motion.fault != machine::Fault::none)
    warnings.emplace_back(fmt::format("the machine has the fault '{}' at {:.3f} s: used up to there",
                                      to_string(motion.fault), motion.ends - motion.begins));
}

}  // namespace

Identification identify(const IdentifyRequest& request) {
  Identification found;
  machine::CalibratedParameters before;
  found.machine = machine::load_machine(request.machine, before);
  const machine::RecordedMotion motion = machine::read_motion(request.record);
  machine::require_same_machine(motion, found.machine);
  found.seconds = motion.ends - motion.begins;
  if (found.seconds < kShortest || motion.commands.empty())
    throw InputError(
        {request.record},
        fmt::format("it has {:.3f} s{}: at least {:g} s of motion are needed, and minutes to "
                    "tell anything well",
                    found.seconds, motion.commands.empty() ? " without a command" : "", kShortest));
  found.record = request.record;
  found.record_sha256 = sha256_hex(read_file(request.record));
  found.command = request.command;
  warn_of_record(motion, found.warnings);
  found.axes = fit_all(motion, request, found.machine);
  for (const IdentifiedAxis& axis : found.axes) {
    tell_untold(axis, found.untold);
    warn_of_fit(axis, found.warnings);
  }
  found.untold.emplace_back("extruder lag: a port measures no flow");
  if (!motion.load.empty() && !found.machine.is_chain()) store_hexapod(before, found);
  return found;
}

}  // namespace understudy::calibration
