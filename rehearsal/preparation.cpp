#include "rehearsal/preparation.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "control/registration/moved_program.h"
#include "control/registration/part_pose_file.h"
#include "core/error.h"
#include "core/file/file_cache.h"
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
#include "sim/plant/hexapod_assembly.h"
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
  mended.findings.insert(mended.findings.end(), read.extrusion.begin(), read.extrusion.end());
  for (const auto& lines : read.passed_over) mended.passed_over.emplace_back(lines.line, lines.last_line);
  mended.facts = std::move(read.facts);
  mended.features = std::move(read.features);
  mended.start_block_end = read.start_block_end;
  mended.beads = std::move(read.beads);
}

/// The program, and the part as the controller holds it, go to where the part was found.
void believe_part_pose(const RehearsalRequest& request, TwinSetup& setup) {
  if (!setup.part)
    throw InputError("--part-pose needs the part that was found: --fixture FILE.stl or a name");
  if (request.registration.wanted)
    throw InputError("--part-pose and --register exclude each other: is the part found, or to be found?");
  const control::PartPose pose = control::read_part_pose(request.part_pose);
  const auto check = [&](const char* what, const std::string& told, const std::string& actual) {
    if (!told.empty() && told != actual)
      throw InputError({request.part_pose},
                       fmt::format("the part was found with another {}, of checksum {:.12}... and not "
                                   "{:.12}...: find it with this one, by understudy register",
                                   what, told, actual));
  };
  check("machine file", pose.machine_sha256, setup.machine.sha256);
  check("part", pose.part_sha256, cached_sha256(machine::find_fixture(request.fixture)));
  setup.program = control::moved_program(setup.program, pose.X_W);
  setup.part = control::moved_part(*setup.part, pose.X_W);
}

/// What cannot be fed is refused, or left out.
void mend_filament(const RehearsalRequest& request, TwinSetup& setup, Mended& mended) {
  if (request.dialect.strict) check_process(setup.program, setup.machine, setup.material);
  const auto faults = mend_process(setup.program, setup.machine, setup.material);
  mended.findings.insert(mended.findings.end(), faults.begin(), faults.end());
}

}  // namespace

TwinSetup prepare(const RehearsalRequest& request, Mended& mended) {
  const auto& engines = engine_names();
  if (std::find(engines.begin(), engines.end(), request.engine) == engines.end())
    throw InputError(fmt::format("unknown engine '{}': one of {}", request.engine, fmt::join(engines, ", ")));
  TwinSetup setup;
  setup.machine = machine::load_machine(request.machine, setup.calibrated);
  setup.cure = machine::load_cure(request.machine);
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
    if (!setup.cure) mend_filament(request, setup, mended);
  }
  if (!request.fixture.empty())
    setup.part = read_fixture(machine::find_fixture(request.fixture), setup.machine);
  setup.workblank = prepare_workblank(request.surface, setup.machine);
  const sim::TruthSeeds seeds = request.truth_seeds.value_or(request.seed);
  setup.as_built = sim::make_as_built(
      setup.machine, request.as_built.empty() ? sim::default_as_built(setup.machine) : request.as_built,
      seeds, request.fixture);
  sim::check_stands_at_home(setup.machine, setup.as_built);
  setup.truth = sim::true_description(setup.machine, setup.as_built);
  setup.built_part = sim::true_part(setup.part, setup.as_built.part);
  if (!request.part_pose.empty()) believe_part_pose(request, setup);
  if (setup.machine.tool.prints() && !setup.cure)
    setup.layers = std::make_shared<ProgrammedLayers>(
        setup.program, setup.machine, setup.part, told_layer(request.dialect, mended.facts), mended.beads);
  if (const auto other = other_flow(setup.program, setup.machine, mended.beads))
    mended.findings.push_back(*other);
  for (Finding& finding : process_warnings(request.dialect, setup.machine.tool, mended.facts,
                                           setup.layers ? setup.layers->typical_layer() : 0))
    mended.findings.push_back(std::move(finding));
  if (setup.machine.tool.prints() && !setup.cure)
    if (const auto other = other_material(setup.material.name, mended.facts))
      mended.findings.push_back(*other);
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
