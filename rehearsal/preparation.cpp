#include "rehearsal/preparation.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "rehearsal/findings/process_check.h"
#include "rehearsal/fixture.h"
#include "rehearsal/placement/home_posture.h"
#include "rehearsal/program/asked_path.h"
#include "rehearsal/program/program_reading.h"
#include "rehearsal/program/reachable_program.h"
#include "rehearsal/program/robot_reading.h"
#include "rehearsal/program/told_process.h"
#include "rehearsal/registration.h"
#include "rehearsal/removal.h"
#include "rehearsal/request/memory_need.h"
#include "sim/as_built/truth.h"
#include "toolpath/crowding.h"
#include "toolpath/duration.h"

namespace understudy::rehearsal {
namespace {

machine::AcceptedErrors accepted_errors(const RehearsalRequest& request) {
  machine::AcceptedErrors accepted = machine::load_accepted_errors(request.machine);
  if (request.tip_tolerance_mm) accepted.tip = from_mm(*request.tip_tolerance_mm);
  if (request.orientation_tolerance_deg) accepted.orientation = from_deg(*request.orientation_tolerance_deg);
  return accepted;
}

void read_into(const RehearsalRequest& request, TwinSetup& setup, Mended& mended) {
  ReadProgram read = read_program(request, setup.machine);
  setup.program = std::move(read.program);
  mended.findings =
      read.of_robot ? robot_program_findings(setup.program, request.machine) : findings_of(read.passed_over);
  for (const auto& lines : read.passed_over) mended.passed_over.emplace_back(lines.line, lines.last_line);
  mended.facts = std::move(read.facts);
  mended.features = std::move(read.features);
}

/// What cannot be fed is refused, or left out.
void mend_filament(const RehearsalRequest& request, TwinSetup& setup, Mended& mended) {
  if (request.dialect.strict) check_process(setup.program, setup.machine, setup.material);
  const auto faults = mend_process(setup.program, setup.machine, setup.material);
  mended.findings.insert(mended.findings.end(), faults.begin(), faults.end());
}

}  // namespace

control::GapControl gap_control_of(const std::string& word, const machine::MachineDescription& machine) {
  if (word == "off" || (word.empty() && !machine.has_microscope)) return control::GapControl::off;
  if (word.empty() || word == "start" || word == "continuous") {
    if (machine.has_microscope)
      return word == "continuous" ? control::GapControl::continuous : control::GapControl::start;
    throw InputError(
        fmt::format("gap control '{}' needs a laser and a microscope; {} has none: off", word, machine.name));
  }
  throw InputError("gap control '" + word + "': one of off, start, continuous");
}

TwinSetup prepare(const RehearsalRequest& request, Mended& mended) {
  const auto& engines = engine_names();
  if (std::find(engines.begin(), engines.end(), request.engine) == engines.end())
    throw InputError(fmt::format("unknown engine '{}': one of {}", request.engine, fmt::join(engines, ", ")));
  TwinSetup setup;
  setup.machine = machine::load_machine(request.machine, setup.calibrated);
  stand_at_home(request.home_axes, setup.machine);
  check_memory(request);
  if (request.dialect.nozzle_mm && setup.machine.tool.prints())
    mount_nozzle(setup.machine.tool, from_mm(*request.dialect.nozzle_mm));
  if (!request.program.empty()) read_into(request, setup, mended);
  setup.asked = asked_path(request, setup.machine);
  toolpath::check_duration(setup.program, (setup.machine.X_WB * setup.machine.X_BT_home).translation(),
                           request.max_time);
  toolpath::check_crowding(setup.program);
  if (setup.machine.tool.prints()) {
    setup.material =
        machine::load_material(request.material.empty() ? setup.machine.process.material : request.material);
    mend_filament(request, setup, mended);
  }
  if (!request.fixture.empty())
    setup.part = read_fixture(machine::find_fixture(request.fixture), setup.machine);
  setup.workblank = prepare_workblank(request.surface, setup.machine);
  const sim::TruthSeeds seeds = request.truth_seeds.value_or(request.seed);
  setup.as_built = sim::make_as_built(
      setup.machine, request.as_built.empty() ? sim::default_as_built(setup.machine) : request.as_built,
      seeds);
  setup.truth = sim::true_description(setup.machine, setup.as_built);
  setup.built_part = sim::true_part(setup.part, setup.as_built.part);
  if (setup.machine.tool.prints())
    setup.layers = std::make_shared<ProgrammedLayers>(setup.program, setup.machine, setup.part,
                                                      told_layer(request.dialect, mended.facts));
  for (Finding& finding : process_warnings(request.dialect, setup.machine.tool, mended.facts,
                                           setup.layers ? setup.layers->typical_layer() : 0))
    mended.findings.push_back(std::move(finding));
  setup.registration = registration_task(request, setup.machine, setup.part, setup.program);
  setup.accepted = accepted_errors(request);
  setup.engine = request.engine;
  setup.seed = seeds[sim::TruthGroup::noise];
  setup.faults = resolve_faults(request.faults, setup.machine);
  setup.camera_faults = resolve_camera_faults(request.camera_faults, setup.machine);
  return setup;
}

std::vector<Finding> check_limits(const RehearsalRequest& request, TwinSetup& setup, Mended& mended) {
  const auto misread = misread_words(request, setup.program, setup.machine);
  Reach reach = check_reach(setup.program, setup.machine, request.dialect.strict);
  if (misread) reach.findings.push_back(*misread);
  mended.passed_over.insert(mended.passed_over.end(), reach.passed_over.begin(), reach.passed_over.end());
  std::sort(mended.passed_over.begin(), mended.passed_over.end());
  return std::move(reach.findings);
}

}  // namespace understudy::rehearsal
