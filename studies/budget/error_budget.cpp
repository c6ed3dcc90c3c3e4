#include "studies/budget/error_budget.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/run_journal.h"
#include "core/parallel.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/request/input_digest.h"
#include "sim/as_built/as_built.h"

namespace understudy::studies {
namespace {

using rehearsal::Record;
using sim::TruthGroup;

constexpr int kSamplesMax = 100'000;
constexpr double kMicrometres = 1e3;  // of a millimetre
constexpr std::array kQuantities{BudgetQuantity::start_gap_error, BudgetQuantity::path_gap_error,
                                 BudgetQuantity::tip_error, BudgetQuantity::in_band_fraction};

bool camera_in_use(const rehearsal::RehearsalRequest& print, const machine::MachineDescription& machine) {
  return machine.has_microscope && print.gap_control != "off";
}

/// What acts through pictures only.
bool seen_by_camera(TruthGroup group) {
  return group == TruthGroup::mounting || group == TruthGroup::camera || group == TruthGroup::light;
}

bool stopped_early(const Record& record) {
  return !record.gap ||
         std::any_of(record.findings.begin(), record.findings.end(),
                     [](const rehearsal::Finding& f) { return f.about == rehearsal::kStopped; });
}

InputError nothing_varies(const machine::MachineDescription& machine, const std::string& as_built) {
  if (as_built == "sampled" || as_built == "manufactured" || as_built == "calibrated")
    return {Place{machine.file.string(), 0, 0},
            fmt::format("as-built {}: no tolerance of what acts here is above 0, nothing varies; state some "
                        "(docs/machine-description.md)",
                        as_built)};
  return InputError(
      fmt::format("as-built {} is one machine, nothing varies; a budget needs one of sampled, manufactured, "
                  "calibrated",
                  as_built));
}

BudgetAnswer answer_of(const Record& record) {
  BudgetAnswer answer;
  answer.stopped = stopped_early(record);
  const auto set = [&](BudgetQuantity quantity, double value) {
    answer.values[static_cast<std::size_t>(quantity)] = value;
  };
  set(BudgetQuantity::in_band_fraction, answer.stopped ? 0 : record.gap->in_band_fraction);
  if (!record.gap) return answer;
  const double commanded_mm = record.gap->commanded_mm;
  set(BudgetQuantity::start_gap_error, kMicrometres * (record.gap->start_mm - commanded_mm));
  if (answer.stopped) return answer;
  set(BudgetQuantity::path_gap_error, kMicrometres * (record.gap->path_mean_mm - commanded_mm));
  if (record.accuracy) set(BudgetQuantity::tip_error, record.accuracy->tip_p95_um);
  return answer;
}

RunJournal::Answer numbers_of(const BudgetAnswer& answer) {
  RunJournal::Answer numbers{answer.stopped ? 1.0 : 0.0};
  for (const auto& value : answer.values) numbers.push_back(value.value_or(std::nan("")));
  return numbers;
}

BudgetAnswer answer_in(const RunJournal::Answer& numbers) {
  BudgetAnswer answer;
  answer.stopped = numbers.at(0) != 0;
  for (std::size_t i = 0; i < kBudgetQuantities; ++i)
    if (!std::isnan(numbers.at(i + 1))) answer.values[i] = numbers[i + 1];
  return answer;
}

/// World 0 is the sample's a, 1 its b, 2 + g is a with group g from b.
sim::TruthSeeds seeds_of(const BudgetRequest& request, const BudgetPlan& plan, std::size_t sample,
                         std::size_t world) {
  const std::uint64_t a = request.first_seed + 2 * sample, b = a + 1;
  sim::TruthSeeds seeds(world == 1 ? b : a);
  if (world >= 2) seeds[plan.groups[world - 2]] = b;
  return seeds;
}

void describe(const Record& record, ErrorBudget& budget) {
  budget.machine = record.machine_name;
  budget.gap_control = record.gap_control;
  budget.machine_sha256 = record.provenance.machine_sha256;
  budget.program_sha256 = record.provenance.program_sha256;
  if (record.engine) budget.engine = record.engine->name;
}

}  // namespace

QuantityWords words(BudgetQuantity quantity) {
  constexpr std::array<QuantityWords, kBudgetQuantities> kWords{
      {{"start_gap_error_um", "um", "gap at the start, less the commanded gap"},
       {"path_gap_error_um", "um", "mean gap along the path, less the commanded gap"},
       {"tip_error_um", "um", "tip error, 95 % of the path below"},
       {"in_band_fraction", "1", "share of the path with the gap in the accepted band"}}};
  return kWords[static_cast<std::size_t>(quantity)];
}

BudgetPlan plan_budget(const BudgetRequest& request) {
  if (request.samples < kBudgetSamplesMin || request.samples > kSamplesMax)
    throw InputError(fmt::format("--samples {} is outside {}..{} of a budget", request.samples,
                                 kBudgetSamplesMin, kSamplesMax));
  const machine::MachineDescription machine = machine::load_machine(request.print.machine);
  BudgetPlan plan;
  plan.as_built = request.print.as_built.empty() ? sim::default_as_built(machine) : request.print.as_built;
  plan.groups = sim::drawn_truths(machine, plan.as_built, request.print.fixture);
  const bool camera = camera_in_use(request.print, machine);
  if (!camera) std::erase_if(plan.groups, seen_by_camera);
  if (plan.groups.empty()) throw nothing_varies(machine, plan.as_built);
  if (camera) plan.groups.push_back(TruthGroup::noise);
  plan.rehearsals = request.samples * static_cast<int>(plan.groups.size() + 2);
  return plan;
}

QuantityBudget share_out(BudgetQuantity quantity, const std::vector<std::vector<BudgetAnswer>>& answers) {
  const auto which = static_cast<std::size_t>(quantity);
  QuantityBudget budget;
  budget.quantity = quantity;
  PickFreeze outputs;
  outputs.mixed.resize(answers.empty() ? 0 : answers[0].size() - 2);
  for (const auto& worlds : answers) {
    const bool complete = std::all_of(worlds.begin(), worlds.end(), [&](const BudgetAnswer& answer) {
      return answer.values[which].has_value();
    });
    if (!complete) continue;
    outputs.a.push_back(*worlds[0].values[which]);
    outputs.b.push_back(*worlds[1].values[which]);
    for (std::size_t g = 0; g < outputs.mixed.size(); ++g)
      outputs.mixed[g].push_back(*worlds[g + 2].values[which]);
  }
  budget.samples = static_cast<int>(outputs.a.size());
  if (outputs.a.size() < 2 || 2 * outputs.a.size() < answers.size()) {
    budget.why = fmt::format("only {} of {} samples have it in every rehearsal, less than half",
                             outputs.a.size(), answers.size());
    return budget;
  }
  double sum = 0, squares = 0;
  for (const auto* world : {&outputs.a, &outputs.b})
    for (const double value : *world) sum += value;
  const double n = 2 * static_cast<double>(outputs.a.size());
  budget.mean = sum / n;
  for (const auto* world : {&outputs.a, &outputs.b})
    for (const double value : *world) squares += (value - budget.mean) * (value - budget.mean);
  budget.sigma = std::sqrt(squares / (n - 1));
  budget.shares = sobol_indices(outputs);
  if (budget.shares.empty()) budget.why = "it is the same on all machines";
  return budget;
}

ErrorBudget run_budget(const BudgetRequest& request, const Progress& progress) {
  ErrorBudget budget;
  budget.plan = plan_budget(request);
  budget.samples = request.samples;
  budget.first_seed = request.first_seed;
  budget.command = request.print.command;
  const std::size_t worlds = budget.plan.groups.size() + 2;
  budget.answers.assign(static_cast<std::size_t>(request.samples), std::vector<BudgetAnswer>(worlds));
  RunJournal journal(request.journal, fmt::format("budget, {} samples from {}, {}, {} groups, of {}",
                                                  request.samples, request.first_seed, budget.plan.as_built,
                                                  worlds - 2, rehearsal::inputs_sha256(request.print)));
  const auto rehearse_one = [&](std::size_t job) {
    const std::size_t sample = job / worlds, world = job % worlds;
    rehearsal::RehearsalRequest one = request.print;
    one.as_built = budget.plan.as_built;
    one.truth_seeds = seeds_of(request, budget.plan, sample, world);
    one.keep_scene = false;
    one.compare_without_gap_control = false;
    const Record record = rehearsal::rehearse(one);
    if (job == 0) describe(record, budget);
    return answer_of(record);
  };
  const auto run = [&](std::size_t job) {
    const auto known = journal.find(job);
    const BudgetAnswer answer = known ? answer_in(*known) : rehearse_one(job);
    if (!known) journal.add(job, numbers_of(answer));
    budget.answers[job / worlds][job % worlds] = answer;
  };
  journal.confirm(numbers_of(rehearse_one(0)));
  const int all = budget.plan.rehearsals;
  in_parallel(static_cast<std::size_t>(all), request.threads, run, [&](std::size_t, std::size_t done) {
    if (progress) progress(static_cast<double>(done) / all, fmt::format("rehearsal {} of {}", done, all));
  });
  journal.remove();
  for (const auto& sample : budget.answers)
    budget.stopped += static_cast<int>(
        std::count_if(sample.begin(), sample.end(), [](const BudgetAnswer& a) { return a.stopped; }));
  for (const BudgetQuantity quantity : kQuantities)
    budget.quantities.push_back(share_out(quantity, budget.answers));
  return budget;
}

}  // namespace understudy::studies
