#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/doctor.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::cli {
namespace {

std::string range_text(const kinematics::Mechanism& mechanism, int axis) {
  const bool angle = mechanism.axis_is_angle(axis);
  const double unit = angle ? kDegree : kMillimetre;
  const char* name = angle ? "deg" : "mm";
  const auto [lower, upper] = mechanism.axis_range(axis);
  if (!std::isfinite(lower) && !std::isfinite(upper)) return "endless";
  if (!std::isfinite(lower)) return fmt::format("to {:g} {}", upper / unit, name);
  if (!std::isfinite(upper)) return fmt::format("from {:g} {}", lower / unit, name);
  return fmt::format("{:g}..{:g} {}", lower / unit, upper / unit, name);
}

/// "l1-l6 170..240 mm": neighbours with the same range share it.
std::string axes_text(const kinematics::Mechanism& mechanism) {
  std::string text;
  for (int first = 0, next = 0; first < mechanism.axis_count(); first = next) {
    const std::string range = range_text(mechanism, first);
    next = first + 1;
    while (next < mechanism.axis_count() && range_text(mechanism, next) == range) ++next;
    const std::string names =
        mechanism.axis_name(first) + (next - first > 1 ? "-" + mechanism.axis_name(next - 1) : "");
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", names, range);
  }
  return text;
}

std::string tool_text(const machine::Tool& tool) {
  return tool.prints() ? fmt::format("nozzle {:.1f} mm", to_mm(tool.nozzle_diameter))
                       : fmt::format("end mill {:.1f} mm", to_mm(tool.flat_diameter));
}

int list_machines() {
  for (const auto& name : machine::machine_names()) {
    const auto m = machine::load_machine(name);
    fmt::print("{:<12} {}; {}; {}; {}\n", m.name, m.mechanism, axes_text(*m.make_mechanism()),
               tool_text(m.tool), m.file.string());
  }
  return kGood;
}

int doctor() {
  bool healthy = true;
  for (const auto& check : self_test()) {
    fmt::print("{} {:<10} {}\n", check.ok ? "ok  " : "FAIL", check.name, check.detail);
    healthy = healthy && check.ok;
  }
  for (const auto& [library, version] : library_versions_in_use())
    fmt::print("lib  {:<13} {}\n", library, version);
  return healthy ? kGood : kFailed;
}

}  // namespace

void add_inspection(CLI::App& app, Action& action) {
  app.add_subcommand("machines", "List the machines under models/")->callback([&action] {
    action = list_machines;
  });
  app.add_subcommand("doctor", "Check that engine, renderer and models work on this computer")
      ->callback([&action] { action = doctor; });
}

}  // namespace understudy::cli
