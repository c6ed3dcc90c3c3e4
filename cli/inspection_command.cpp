#include <fmt/format.h>

#include "cli/command.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/doctor.h"

namespace understudy::cli {
namespace {

int list_machines() {
  for (const auto& name : machine::machine_names()) {
    const auto m = machine::load_machine(name);
    fmt::print("{:<12} {}, struts {:.0f}..{:.0f} mm, nozzle {:.1f} mm, {}\n", m.name, m.mechanism,
               to_mm(m.limits.strut_min), to_mm(m.limits.strut_max), to_mm(m.tool.nozzle_diameter),
               m.file.string());
  }
  return kGood;
}

int doctor() {
  bool healthy = true;
  for (const auto& check : rehearsal::examine()) {
    fmt::print("{} {:<10} {}\n", check.ok ? "ok  " : "FAIL", check.name, check.detail);
    healthy = healthy && check.ok;
  }
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
