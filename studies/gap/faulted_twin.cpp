#include "studies/gap/faulted_twin.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "sim/as_built/truth.h"
#include "studies/gap/gap_bench.h"
#include "studies/gap/injected_fault.h"
#include "studies/gap/lab_machine.h"

namespace understudy::studies {
namespace {

constexpr double kBead = 12e-3;  // [m], on the plate: about as long as the bottle's line

std::vector<FaultWorld> make_worlds(const FaultedTwinRequest& request,
                                    const machine::MachineDescription& drawn, std::size_t number) {
  const std::uint64_t seed = request.seed + number;
  const LabMachine lab = make_lab_machine(drawn, seed);
  std::vector<FaultWorld> worlds;
  for (const GapSurface& surface : gap_surfaces(drawn, request.program, kBead)) {
    const bool plate = surface.name.starts_with("tilted");  // the tool would have to lean with it
    if (plate) continue;
    FaultWorld world{seed, surface.name, {}, {}, {}};
    rehearsal::TwinSetup& setup = world.setup;
    setup.machine = lab.machine;
    setup.calibrated = lab.calibrated;
    setup.truth = lab.truth;
    setup.material = machine::load_material(lab.machine.process.material);
    setup.program = request.task == FaultedTask::approach ? until_bead(surface.program) : surface.program;
    setup.part = surface.part;
    setup.built_part = sim::true_part(surface.part, lab.built.part);
    setup.as_built = lab.built;
    setup.engine = request.plants.front().engine;
    setup.timestep = request.plants.front().timestep;
    setup.seed = seed;
    world.window.X_WT_S = surface.X_WT_S;
    prove_sound(request.task, world);
    worlds.push_back(std::move(world));
  }
  return worlds;
}

PlantDifference difference(const std::vector<FaultedTrial>& first, const std::vector<FaultedTrial>& other) {
  PlantDifference difference;
  std::vector<double> gaps;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i].answer != other[i].answer)
      ++difference.other_answers;
    else
      gaps.push_back(std::abs(first[i].least_gap - other[i].least_gap));
  if (gaps.empty()) return difference;
  difference.gap_median = quantile(gaps, 0.5);
  difference.gap_p95 = quantile(gaps, 0.95);
  difference.gap_max = *std::max_element(gaps.begin(), gaps.end());
  return difference;
}

/// Those that are asked for, in the order of fault_types().
std::vector<FaultType> types_of(const FaultedTwinRequest& request) {
  std::vector<FaultType> types;
  std::vector<std::string> known;
  for (const FaultType& type : fault_types()) {
    known.emplace_back(type.name);
    const bool asked =
        std::find(request.faults.begin(), request.faults.end(), type.name) != request.faults.end();
    if (request.faults.empty() || asked) types.push_back(type);
  }
  for (const std::string& name : request.faults)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--fault '{}': one of {}", name, fmt::join(known, ", ")));
  return types;
}

void require(const FaultedTwinRequest& request) {
  if (request.trials < 1 || request.trials > 1'000'000)
    throw InputError(fmt::format("--trials {} is outside 1..1000000", request.trials));
  if (request.worlds < 1 || request.worlds > 100'000)
    throw InputError(fmt::format("--machines {} is outside 1..100000", request.worlds));
  if (request.plants.empty()) throw InputError("--plant: at least one is needed");
}

}  // namespace

int PlantTrials::count(Judgement judgement) const {
  return static_cast<int>(std::count_if(trials.begin(), trials.end(),
                                        [&](const FaultedTrial& t) { return t.judgement == judgement; }));
}

bool PlantTrials::good() const {
  return count(Judgement::right) + count(Judgement::not_in_play) == static_cast<int>(trials.size());
}

std::vector<ConfusionCell> confusion(const std::vector<FaultedTrial>& trials) {
  std::vector<ConfusionCell> cells;
  for (const FaultType& type : fault_types()) {
    std::map<std::string, ConfusionCell> row;
    for (const FaultedTrial& trial : trials) {
      if (trial.fault != type.name) continue;
      ConfusionCell& cell = row[trial.answer];
      cell.fault = type.name;
      cell.answer = trial.answer;
      if (trial.judgement == Judgement::right)
        ++cell.right;
      else if (trial.judgement == Judgement::not_in_play)
        ++cell.not_in_play;
      else
        ++cell.wrong;
    }
    for (auto& [answer, cell] : row) cells.push_back(std::move(cell));
  }
  return cells;
}

FaultedTwin run_faulted_twin(const FaultedTwinRequest& request, const Progress& progress) {
  require(request);
  const std::vector<FaultType> types = types_of(request);
  const auto drawn = machine::load_machine(request.machine);
  FaultedTwin result;
  result.task = request.task;
  result.worlds = request.worlds;
  const auto count = static_cast<std::size_t>(request.worlds);
  const std::size_t plants = request.plants.size(), trials = static_cast<std::size_t>(request.trials);
  const double all = static_cast<double>(count + plants * trials);
  std::vector<std::vector<FaultWorld>> made(count);
  in_parallel(
      count, request.threads, [&](std::size_t i) { made[i] = make_worlds(request, drawn, i); },
      [&](std::size_t, std::size_t done) {
        if (progress) progress(static_cast<double>(done) / all, fmt::format("machine {} of {}", done, count));
      });
  std::vector<FaultWorld> worlds;
  for (auto& of_machine : made)
    for (FaultWorld& world : of_machine)
      if (world.unsound.empty())
        worlds.push_back(std::move(world));
      else
        result.unsound.push_back({world.seed, world.surface, world.unsound});
  if (worlds.empty())
    throw MachineError("no built machine ends well without a fault; the first: " +
                       result.unsound.front().why);
  for (const PlantChoice& plant : request.plants)
    result.plants.push_back({plant, std::vector<FaultedTrial>(trials), {}});
  in_parallel(
      plants * trials, request.threads,
      [&](std::size_t job) {
        stop_if_interrupted();
        const std::size_t trial = job % trials;
        const FaultType& type = types[trial % types.size()];
        const FaultWorld& world = worlds[trial / types.size() % worlds.size()];
        PlantTrials& on = result.plants[job / trials];
        on.trials[trial] =
            run_faulted_trial(world, request.task, type, on.plant, request.seed, static_cast<int>(trial));
      },
      [&](std::size_t, std::size_t done) {
        if (progress)
          progress(static_cast<double>(count + done) / all,
                   fmt::format("trial {} of {}", done, plants * trials));
      });
  for (PlantTrials& on : result.plants) on.difference = difference(result.plants.front().trials, on.trials);
  return result;
}

}  // namespace understudy::studies
