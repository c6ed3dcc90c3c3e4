#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "core/error.h"
#include "core/file/number_table.h"
#include "core/units.h"
#include "machine/default_machine.h"
#include "machine/pose_table.h"

namespace understudy::cli {
namespace {

using kinematics::Mechanism;

const std::vector<std::string> kPoseHeader{"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
constexpr double kUnitTolerance = 1e-4;  // as in G-code

std::vector<std::string> axis_header(const Mechanism& mechanism) {
  std::vector<std::string> header;
  for (int i = 0; i < mechanism.axis_count(); ++i)
    header.push_back(mechanism.axis_name(i) + (mechanism.axis_is_angle(i) ? "_deg" : "_mm"));
  return header;
}

double file_unit(const Mechanism& mechanism, int axis) {
  return mechanism.axis_is_angle(axis) ? kDegree : kMillimetre;
}

/// A pose of a row, in W; the quaternion must be of unit length.
Pose pose_of(const NumberRow& row) {
  const auto& v = row.values;
  const Quat q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > kUnitTolerance)
    throw InputError(
        {"standard input", row.line, 4},
        fmt::format("the quaternion's length is {:.6f}, not 1 within {:g}", q.norm(), kUnitTolerance));
  return make_pose(q, from_mm(1) * Vec3(v[0], v[1], v[2]));
}

/// "ok", or why there is no usable answer: the first limit that the pose breaks.
struct Status {
  std::string text;
  bool only_singular = false;  // the axes may stand there, though no program may lead through
};

Status status_of(const Mechanism& mechanism, const Pose& X_BT, std::span<const double> axes) {
  std::vector<kinematics::LimitViolation> violations;
  mechanism.check(X_BT, axes, violations);
  if (violations.empty()) return {"ok"};
  const bool singular = std::ranges::all_of(
      violations, [](const auto& violation) { return violation.kind == kinematics::LimitKind::singularity; });
  return {to_string(violations.front()), singular};
}

int print_axes(const std::string& name) {
  const auto machine = machine::load_machine(name);
  const auto mechanism = machine.make_mechanism();
  const auto rows = read_number_table(std::cin, "standard input", kPoseHeader);
  std::vector<Pose> poses;
  for (const auto& row : rows) poses.push_back(machine.X_WB.inverse() * pose_of(row));
  const auto solved = machine::solve_axes(machine, poses);
  const auto n = static_cast<std::size_t>(mechanism->axis_count());
  std::string out = fmt::format("{},status\n", fmt::join(axis_header(*mechanism), ","));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto& [solve_status, axes] = solved[k];
    const std::string status = solve_status == kinematics::SolveStatus::ok
                                   ? status_of(*mechanism, poses[k], axes).text
                                   : to_string(solve_status);
    for (std::size_t i = 0; i < n; ++i)
      out += status == "ok" ? fmt::format("{:.6f},", axes[i] / file_unit(*mechanism, static_cast<int>(i)))
                            : "nan,";
    out += status + "\n";
  }
  fmt::print("{}", out);
  return kGood;
}

std::string pose_row(const Pose& X_WT) {
  Quat q(X_WT.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Vec3 p = X_WT.translation() * 1e3;
  return fmt::format("{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}", p.x(), p.y(), p.z(), q.w(), q.x(),
                     q.y(), q.z());
}

int print_poses(const std::string& name) {
  const auto machine = machine::load_machine(name);
  const auto mechanism = machine.make_mechanism();
  const auto rows = read_number_table(std::cin, "standard input", axis_header(*mechanism));
  std::vector<kinematics::AxisVector> axes(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < rows[k].values.size(); ++i)
      axes[k][i] = rows[k].values[i] * file_unit(*mechanism, static_cast<int>(i));
  const auto solved = machine::solve_poses(machine, axes);
  std::string out = fmt::format("{},status\n", fmt::join(kPoseHeader, ","));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [solve_status, X_BT] = solved[k];
    const Status status = solve_status == kinematics::SolveStatus::ok ? status_of(*mechanism, X_BT, axes[k])
                                                                      : Status{to_string(solve_status)};
    const bool is_there = status.text == "ok" || status.only_singular;
    out +=
        (is_there ? pose_row(machine.X_WB * X_BT) : "nan,nan,nan,nan,nan,nan,nan") + "," + status.text + "\n";
  }
  fmt::print("{}", out);
  return kGood;
}

}  // namespace

void add_kinematics(CLI::App& app, Action& action) {
  auto machine = std::make_shared<std::string>(machine::kDefaultMachine);
  auto* axes =
      app.add_subcommand("axes", "Inverse kinematics: poses.csv on standard input, axes on standard output");
  add_machine_option(*axes, *machine);
  axes->footer(
      "Header: x_mm,y_mm,z_mm,qw,qx,qy,qz, the nozzle tip in the frame of programs. A row without solution "
      "prints nan and the reason.");
  axes->callback([=, &action] { action = [=] { return print_axes(*machine); }; });
  auto* poses =
      app.add_subcommand("poses", "Forward kinematics: axes.csv on standard input, poses on standard output");
  add_machine_option(*poses, *machine);
  poses->footer(
      "Header: the machine's axes, as `understudy axes` prints them; hexapod: l1_mm..l6_mm, strut lengths. A "
      "row of "
      "a singular posture has its pose, and the reason why no program may lead there.");
  poses->callback([=, &action] { action = [=] { return print_poses(*machine); }; });
}

}  // namespace understudy::cli
