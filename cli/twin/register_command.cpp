#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/machine_option.h"
#include "cli/progress.h"
#include "cli/seed_option.h"
#include "cli/twin/registration_options.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "rehearsal/rehearse.h"

namespace understudy::cli {
namespace {

struct RegisterCall {
  rehearsal::RehearsalRequest request;
  std::string output;
};

/// Shifts in um and turns in mrad.
std::string covariance_text(const Mat6& covariance) {
  Eigen::Matrix<double, 6, 1> factor;
  factor << Vec3::Constant(to_um(1)), Vec3::Constant(to_mrad(1));
  const Mat6 scaled = factor.asDiagonal() * covariance * factor.asDiagonal();
  std::string text;
  for (const auto& row : scaled.rowwise()) text += fmt::format("  - [{:.6g}]\n", fmt::join(row, ", "));
  return text;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
  return text;
}

std::string pose_text(const rehearsal::Record& record, const rehearsal::RegistrationFigures& figures) {
  const control::PartFit& fit = *figures.fit;
  const Vec3 p = fit.X_W.translation();
  const Quat q(fit.X_W.linear());
  return fmt::format(
             "# Where the part stands: a point of the drawn part is at R p + position, in W. By: {}\n"
             "part: {}\nmachine: {}\nposition_mm: [{:.6f}, {:.6f}, {:.6f}]\n"
             "quaternion: [{:.9f}, {:.9f}, {:.9f}, {:.9f}]   # w, x, y, z\nreference_mm: [{:.3f}]\n"
             "# Of the shift of the reference point in um and the turn about it in mrad, along x, y, z of "
             "W.\n"
             "covariance:\n",
             command_line(), record.fixture_name, record.machine_word, to_mm(p.x()), to_mm(p.y()),
             to_mm(p.z()), q.w(), q.x(), q.y(), q.z(), fmt::join(figures.reference_mm, ", ")) +
         covariance_text(fit.covariance) +
         fmt::format("unseen: [{}]\nchi_square: {:.3f}\ndegrees_of_freedom: {}\nplaces: {}\n",
                     quoted(figures.unseen), fit.chi_square, fit.degrees_of_freedom, figures.places);
}

int run_register(const RegisterCall& call) {
  check_writable(call.output);
  rehearsal::RehearsalRequest request = call.request;
  request.registration.wanted = true;
  request.gap_control = "off";
  request.keep_scene = false;
  request.compare_without_gap_control = false;
  request.command = command_line();
  rehearsal::Record record;
  {
    ProgressLine line;
    record =
        rehearsal::rehearse(request, [&](double share, const std::string& what) { line.show(share, what); });
  }
  stop_if_interrupted();
  if (!record.registration) throw MachineError("the machine was not run");
  const rehearsal::RegistrationFigures& figures = *record.registration;
  const bool found = figures.fit && record.go;
  fmt::print("{} on {}: {}\n", record.fixture_name, record.machine_name, found ? "found" : "not found");
  for (const auto& finding : record.findings)
    if (finding.severity == rehearsal::Severity::error)
      fmt::print("  {}: {}\n", finding.kind, finding.message);
  print_registration(figures);
  if (!found) return kNo;
  write_file(call.output, pose_text(record, figures));
  fmt::print("pose: {}\n", call.output);
  return kGood;
}

}  // namespace

void add_register(CLI::App& app, Action& action) {
  auto call = std::make_shared<RegisterCall>();
  call->request.engine = "quasistatic";
  auto* command = app.add_subcommand(
      "register", "Find where a clamped part stands, by the twin's own gap sensor (docs/registration.md)");
  command
      ->add_option("--fixture", call->request.fixture, "the part: an STL in mm, or a name under models/parts")
      ->required();
  add_machine_option(*command, call->request.machine);
  add_registration_options(*command, call->request.registration);
  command->add_option("--engine", call->request.engine, "plant: mujoco, bullet (hexapod, arm), quasistatic")
      ->capture_default_str();
  command->add_option("--as-built", call->request.as_built,
                      "the machine and the part that stand there, as for `rehearse`");
  command->add_option("--seed", call->request.seed, "of the as-built errors and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "pose of the part with its covariance, a .yaml")
      ->required();
  command->footer(
      "Example: understudy register --fixture bottle --as-built manufactured --seed 4 -o pose.yaml\n"
      "`understudy rehearse --register` finds the part and then prints on it where it stands.");
  command->callback([=, &action] { action = [=] { return run_register(*call); }; });
}

}  // namespace understudy::cli
