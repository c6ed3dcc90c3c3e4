#include "rehearsal/inspection/print_time.h"

#include <algorithm>
#include <cmath>

#include "control/motion/motion_planner.h"
#include "core/error.h"
#include "core/units.h"
#include "rehearsal/program/program_reading.h"
#include "rehearsal/program/told_process.h"
#include "toolpath/inspection/slicer_time.h"

namespace understudy::rehearsal {
namespace {

constexpr double kSameLimit = 0.05;  // of the machine's

std::optional<double> planned_time(const toolpath::Program& program,
                                   const machine::MachineDescription& machine) {
  using toolpath::StepKind;
  const auto mechanism = machine.make_mechanism();
  control::MotionPlanner planner(*mechanism, machine.X_WB, control::motion_limits(machine),
                                 {machine.X_WB * machine.X_BT_home}, control::PoseCheck::solvable);
  control::PlannedPoint point;
  for (const toolpath::Step& step : program.steps) {
    if (step.kind == StepKind::end) break;
    planner.push(step);
    // The print loop comes to rest here.
    if (step.kind == StepKind::temperature || step.kind == StepKind::fan) planner.finish();
    while (planner.next(point)) {
    }
  }
  planner.finish();
  while (planner.next(point)) {
  }
  return planner.time();
}

}  // namespace

std::vector<OtherLimit> other_limits(const machine::MachineDescription& machine,
                                     const std::map<std::string, std::string>& facts) {
  std::vector<OtherLimit> others;
  const auto compare = [&](const char* key, const std::string& name, double here, const char* unit) {
    const auto told = fact_number(facts, key);
    if (told && *told > 0 && std::abs(*told - here) > kSameLimit * here)
      others.push_back({name, *told, here, unit});
  };
  compare("machine_max_acceleration_extruding", "acceleration", to_mm(machine.acceleration), "mm/s2");
  compare("travel_speed", "travel", to_mm(machine.travel_velocity), "mm/s");
  const auto mechanism = machine.make_mechanism();
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    const std::string axis = mechanism->axis_name(i);
    if (axis != "x" && axis != "z") continue;
    const auto& drive = machine.drives[static_cast<std::size_t>(i)];
    compare(axis == "x" ? "machine_max_feedrate_x" : "machine_max_feedrate_z", "speed of " + axis,
            to_mm(drive.velocity_max), "mm/s");
    compare(axis == "x" ? "machine_max_jerk_x" : "machine_max_jerk_z", "jump of " + axis,
            to_mm(drive.velocity_jump), "mm/s");
  }
  return others;
}

PrintTime print_time(const RehearsalRequest& request, const std::map<std::string, std::string>& facts,
                     std::size_t longest) {
  PrintTime time;
  if (const auto said = facts.find("estimated time"); said != facts.end())
    time.slicers = toolpath::written_time(said->second);
  const machine::MachineDescription machine = machine::load_machine(request.machine);
  if (time.slicers) time.limits = other_limits(machine, facts);
  try {
    const ReadProgram read = read_program(request, machine);
    if (read.program.steps.size() <= longest) time.planned = planned_time(read.program, machine);
  } catch (const InputError&) {
    // The rehearsal says what cannot be read, or reached.
  }
  return time;
}

}  // namespace understudy::rehearsal
