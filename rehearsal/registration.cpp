#include "rehearsal/registration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/gap/local_surface.h"
#include "control/registration/moved_program.h"
#include "control/registration/registration_tolerance.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "rehearsal/findings/findings.h"

namespace understudy::rehearsal {
namespace {

bool breaks_limits(const control::ConstraintReport& report) {
  const auto findings = findings_of(report);
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::error; });
}

void compare_with_truth(const TrueGap& true_gap, RegistrationRun& run) {
  for (const control::PlaceReading& place : run.found.places) {
    run.error.emplace_back();
    if (!place.measured || !run.part || place.outcome.samples.empty()) continue;
    const auto truth = true_gap(place.outcome.samples.back().frame.number);
    const auto found = control::height_over(*run.part, place.X_WT_end);
    if (truth && found && std::isfinite(*truth)) run.error.back() = *found - *truth;
  }
}

void fill_fit(const control::PartFit& fit, RegistrationFigures& figures) {
  const Vec3 shift = fit.reference_W - fit.X_W.inverse() * fit.reference_W;
  const Vec3 turn = log_rotation(fit.X_W.linear());
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    figures.reference_mm[i] = to_mm(fit.reference_W[k]);
    figures.shift_um[i] = to_um(shift[k]);
    figures.turn_mrad[i] = to_mrad(turn[k]);
    figures.shift_sigma_um[i] = to_um(std::sqrt(fit.covariance(k, k)));
    figures.turn_sigma_mrad[i] = to_mrad(std::sqrt(fit.covariance(k + 3, k + 3)));
  }
  figures.seen = fit.seen;
  for (const auto& freedom : fit.unseen) figures.unseen.push_back(to_string(freedom));
  figures.chi_square = fit.chi_square;
  figures.degrees_of_freedom = fit.degrees_of_freedom;
  figures.chi_square_limit = fit.chi_square_limit;
  figures.fit = fit;
}

RegistrationRow row_of(const control::PlaceReading& place, const std::optional<double>& error,
                       const std::optional<control::PartFit>& fit) {
  RegistrationRow row;
  for (std::size_t i = 0; i < 3; ++i) row.place_mm[i] = to_mm(place.place.p_W[static_cast<Eigen::Index>(i)]);
  row.why = place.why;
  if (!place.measured) return row;
  row.gap_mm = to_mm(place.outcome.gap);
  row.reading_sigma_um = to_um(place.reading_sigma);
  row.residual_um = to_um(place.residual);
  if (fit)
    row.sigma_um =
        to_um(fit->sigma_along(fit->X_W * place.place.p_W, fit->X_W.linear() * place.place.normal_W));
  if (error) row.error_um = to_um(*error);
  return row;
}

Finding refusal(std::string message) {
  Finding f;
  f.kind = "registration";
  f.unit = "1";
  f.about = kStopped;
  f.message = std::move(message);
  return f;
}

}  // namespace

std::optional<control::RegistrationTask> registration_task(const RehearsalRequest& request,
                                                           const machine::MachineDescription& machine,
                                                           const std::shared_ptr<const geometry::Mesh>& part,
                                                           const toolpath::Program& program) {
  if (!request.registration.wanted) return std::nullopt;
  if (!part)
    throw InputError("registration needs the part that is to be found: --fixture FILE.stl or a name");
  if (!machine.has_microscope)
    throw InputError(fmt::format("registration needs a laser and a microscope; {} has none", machine.name));
  const auto stated = machine::load_built_tolerances(request.machine, request.fixture);
  control::RegistrationTask task;
  task.part = part;
  task.tolerance = control::part_tolerance(stated);
  const control::ProbingCheck check(machine, *part, control::largest_shift(*part, task.tolerance));
  if (!request.registration.pattern.empty()) {
    task.places = control::read_pattern(request.registration.pattern, *part, check);
    task.wanted = static_cast<int>(task.places.size());
  } else {
    task.wanted = request.registration.places;
    task.places = control::choose_places(*part, task.tolerance, check, control::printed_region(program),
                                         task.wanted + task.wanted / 2);
  }
  task.place_sigma = control::place_sigma(stated, machine, task.places);
  return task;
}

bool RegistrationRun::good() const { return found.good() && !breaks_limits(limits); }

RegistrationRun run_registration(const control::RegistrationTask& task, const toolpath::Program& program,
                                 const machine::MachineDescription& machine, machine::MachinePort& port,
                                 const TrueGap& true_gap, bool check_limits) {
  RegistrationRun run;
  run.found = control::register_part(task, machine, port);
  if (run.found.fit) run.part = control::moved_part(*task.part, run.found.fit->X_W);
  compare_with_truth(true_gap, run);
  if (!run.found.good()) return run;
  run.program = control::moved_program(program, run.found.fit->X_W);
  if (check_limits) run.limits = control::check_constraints(run.program, machine);
  return run;
}

RegistrationFigures registration_figures(const RegistrationRun& run, const control::RegistrationTask& task) {
  RegistrationFigures figures;
  figures.places = run.found.measured();
  figures.left_out = static_cast<int>(run.found.places.size()) - figures.places;
  figures.duration_s = run.found.duration;
  figures.refused = run.found.stop ? run.found.stop.why : run.found.refused;
  figures.place_sigma_um = to_um(task.place_sigma);
  if (run.found.fit) fill_fit(*run.found.fit, figures);
  double squares = 0;
  int known = 0;
  for (std::size_t i = 0; i < run.found.places.size(); ++i) {
    figures.rows.push_back(row_of(run.found.places[i], run.error[i], run.found.fit));
    const RegistrationRow& row = figures.rows.back();
    if (row.sigma_um) figures.normal_sigma_max_um = std::max(figures.normal_sigma_max_um, *row.sigma_um);
    if (!row.error_um) continue;
    squares += *row.error_um * *row.error_um;
    figures.normal_error_max_um = std::max(figures.normal_error_max_um, std::abs(*row.error_um));
    ++known;
  }
  if (known > 0) figures.normal_error_rms_um = std::sqrt(squares / known);
  return figures;
}

std::vector<Finding> registration_findings(const RegistrationRun& run) {
  if (run.found.stop) return {refusal("the part could not be registered: " + run.found.stop.why)};
  if (!run.found.refused.empty()) return {refusal("the part is not registered: " + run.found.refused)};
  std::vector<Finding> findings = findings_of(run.limits);
  std::erase_if(findings, [](const Finding& f) { return f.severity != Severity::error; });
  for (Finding& f : findings) f.message += "; with the program moved to where the part stands";
  return findings;
}

}  // namespace understudy::rehearsal
