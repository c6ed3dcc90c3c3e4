#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/machine_option.h"
#include "cli/progress.h"
#include "cli/registration_options.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/output_file.h"
#include "core/units.h"
#include "rehearsal/rehearse.h"

namespace understudy::cli {
namespace {

struct RegisterCall {
  rehearsal::RehearsalRequest request;
  std::string output;
};

/// Units of the covariance: um and mrad.
double in_report_units(const Mat6& covariance, Eigen::Index i, Eigen::Index j) {
  const auto factor = [](Eigen::Index k) { return k < 3 ? 1e6 : 1e3; };
  return factor(i) * factor(j) * covariance(i, j);
}

std::string pose_text(const rehearsal::Record& record, const rehearsal::RegistrationFigures& figures) {
  const control::PartFit& fit = *figures.fit;
  const Vec3 p = 1e3 * fit.X_W.translation();
  const Quat q(fit.X_W.linear());
  std::string text = fmt::format(
      "# Where the part stands: a point of the drawn part is at R p + position, in W. By: {}\n"
      "part: {}\nmachine: {}\nposition_mm: [{:.6f}, {:.6f}, {:.6f}]\n"
      "quaternion: [{:.9f}, {:.9f}, {:.9f}, {:.9f}]   # w, x, y, z\nreference_mm: [{:.3f}]\n"
      "# Of the shift of the reference point in um and the turn about it in mrad, along x, y, z of W.\n"
      "covariance:\n",
      command_line(), record.fixture_name, record.machine_word, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(),
      q.z(), fmt::join(figures.reference_mm, ", "));
  for (Eigen::Index i = 0; i < 6; ++i) {
    text += "  - [";
    for (Eigen::Index j = 0; j < 6; ++j)
      text += fmt::format("{}{:.6g}", j == 0 ? "" : ", ", in_report_units(fit.covariance, i, j));
    text += "]\n";
  }
  text += fmt::format("unseen: [{}]\n", fmt::join(figures.unseen.begin(), figures.unseen.end(), "\", \""));
  if (!figures.unseen.empty()) {
    const auto open = text.rfind("unseen: [") + 9;
    text.insert(open, "\"");
    text.insert(text.rfind(']'), "\"");
  }
  return text + fmt::format("chi_square: {:.3f}\ndegrees_of_freedom: {}\nplaces: {}\n", fit.chi_square,
                            fit.degrees_of_freedom, figures.places);
}

int run_register(const RegisterCall& call) {
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
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "pose of the part with its covariance, a .yaml")
      ->required();
  command->footer(
      "Example: understudy register --fixture bottle --as-built manufactured --seed 4 -o pose.yaml\n"
      "`understudy rehearse --register` finds the part and then prints on it where it stands.");
  command->callback([=, &action] { action = [=] { return run_register(*call); }; });
}

}  // namespace understudy::cli
