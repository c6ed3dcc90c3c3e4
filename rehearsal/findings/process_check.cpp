#include "rehearsal/findings/process_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

constexpr double kWidestBores = 5;           // a bead wider and higher than that many bores is a mistake
constexpr double kLongestRetraction = 0.05;  // [m]
constexpr double kShortestPath = 1e-3;       // [m]: on less, what is fed is a blob
constexpr double kLongestPrime = 0.1;        // [m] of filament fed at a standstill or nearly

class Checker {
 public:
  Checker(const toolpath::Program& program, const machine::MachineDescription& machine,
          const machine::Material& material)
      : program_(program), machine_(machine), material_(material) {}

  void run() {
    Vec3 tip = (machine_.X_WB * machine_.X_BT_home).translation();
    for (const toolpath::Step& step : program_.steps) {
      if (step.kind == toolpath::StepKind::temperature) temperature_ = step.temperature;
      const Vec3 end = step.X_WT.translation();
      if (toolpath::moves(step) || step.filament != 0) check_feed(step, (end - tip).norm());
      if (toolpath::moves(step)) tip = end;
    }
  }

 private:
  [[noreturn]] void fail(const toolpath::Step& step, const std::string& message) const {
    throw InputError({program_.file, step.line, 0}, message);
  }

  void check_feed(const toolpath::Step& step, double path) {
    fed_ += step.filament;
    const double fresh = std::max(0.0, fed_ - most_);
    most_ = std::max(most_, fed_);
    if (most_ - fed_ > kLongestRetraction)
      fail(step, fmt::format("{:.2f} mm of filament are drawn back, more than {:.0f} mm", to_mm(most_ - fed_),
                             to_mm(kLongestRetraction)));
    if (step.filament > 0) check_temperature(step);
    if (fresh > 0) check_amount(step, path, fresh);
  }

  void check_temperature(const toolpath::Step& step) const {
    if (temperature_ <= 0)
      fail(step, "extrudes before any nozzle temperature is set (M104, M109 or --temperature)");
    if (temperature_ <= material_.glass_transition)
      fail(step, fmt::format("extrudes at {:.1f} C, where {} is solid: its glass transition is at {:.1f} C",
                             temperature_ - kCelsiusZero, material_.name,
                             material_.glass_transition - kCelsiusZero));
  }

  void check_amount(const toolpath::Step& step, double path, double fresh) const {
    const double filament = machine_.tool.filament_diameter, bore = machine_.tool.nozzle_diameter;
    const double filament_area = std::numbers::pi / 4 * filament * filament;
    if (path < kShortestPath) {
      if (fresh > kLongestPrime)
        fail(step, fmt::format("feeds {:.1f} mm of filament on {:.3f} mm of path, more than {:.0f} mm",
                               to_mm(fresh), to_mm(path), to_mm(kLongestPrime)));
      return;
    }
    const double area = fresh * filament_area / path;
    const double limit = kWidestBores * kWidestBores * bore * bore;
    if (area <= limit) return;
    fail(step,
         fmt::format("feeds {:.3f} mm of filament over {:.3f} mm: a bead of {:.2f} mm2, more than {:.2f} mm2 "
                     "({:g} bores of {:g} mm wide and high)",
                     to_mm(fresh), to_mm(path), area * 1e6, limit * 1e6, kWidestBores, to_mm(bore)));
  }

  const toolpath::Program& program_;
  const machine::MachineDescription& machine_;
  const machine::Material& material_;
  double temperature_ = 0;     // [K]
  double fed_ = 0, most_ = 0;  // [m]
};

}  // namespace

void check_process(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const machine::Material& material) {
  if (machine.tool.prints()) Checker(program, machine, material).run();
}

std::vector<Finding> temperature_findings(const toolpath::Program& program,
                                          const machine::Material& material) {
  Finding cold, hot;
  for (Finding* f : {&cold, &hot}) {
    f->kind = "flow";
    f->unit = "C";
  }
  cold.severity = Severity::error;
  cold.about = kNozzleCold;
  cold.limit = cold.value = material.nozzle_temperature_min - kCelsiusZero;
  hot.severity = Severity::warning;
  hot.about = kNozzleHot;
  hot.limit = hot.value = material.nozzle_temperature_max - kCelsiusZero;
  const auto widen = [](Finding& f, int line, double celsius) {
    if (f.gcode_line == 0) f.gcode_line = line;
    f.last_line = line;
    if (std::abs(celsius - f.limit) > std::abs(f.value - f.limit)) f.value = celsius;
  };
  double celsius = -kCelsiusZero;
  for (const toolpath::Step& step : program.steps) {
    if (step.kind == toolpath::StepKind::temperature) celsius = step.temperature - kCelsiusZero;
    if (step.filament <= 0 || celsius <= 0) continue;
    if (celsius < cold.limit) widen(cold, step.line, celsius);
    if (celsius > hot.limit) widen(hot, step.line, celsius);
  }
  std::vector<Finding> findings;
  for (Finding* f : {&cold, &hot}) {
    if (f->gcode_line == 0) continue;
    f->message =
        fmt::format("filament is fed at {:.0f} C, {} {} is printed: {:.0f} C", f->value,
                    f == &cold ? "below the lowest temperature at which" : "above the highest at which",
                    material.name, f->limit);
    findings.push_back(*f);
  }
  return findings;
}

}  // namespace understudy::rehearsal
