#include "studies/faults/faulted_prints.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/run_journal.h"
#include "core/interrupt.h"
#include "core/parallel.h"
#include "core/version.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/request/fault_words.h"
#include "studies/faults/drawn_fault.h"
#include "studies/faults/print_pool.h"

namespace understudy::studies {
namespace {

using control::GapStop;
using rehearsal::Record;
using rehearsal::RehearsalRequest;

constexpr int kRunsMax = 1'000'000;
constexpr double kApproachTime = 2.5;                            // [s], of a measured approach, more or less
constexpr int kPowerStop = 100, kOtherStop = 101, kNoStop = -1;  // beyond the values of GapStop
constexpr std::size_t kPrintsPerBlock = 2;

/// A block: none twice, then every other fault once.
std::size_t block_size() { return drawn_fault_kinds().size() + 1; }
const DrawnFaultKind& kind_of(std::size_t run) {
  const std::size_t turn = run % block_size();
  return drawn_fault_kinds()[turn == 0 ? 0 : turn - 1];
}

std::vector<std::string> printing_machines() {
  std::vector<std::string> names;
  for (const std::string& name : machine::machine_names())
    if (machine::load_machine(name).tool.prints()) names.push_back(name);
  return names;
}

std::vector<std::string> seeing(const std::vector<std::string>& machines) {
  std::vector<std::string> names;
  for (const std::string& name : machines)
    if (machine::load_machine(name).has_microscope) names.push_back(name);
  return names;
}

/// Of a block the first print is on a machine that sees, where there is one; for the second all take turns.
std::vector<PoolPrint> make_pool(const FaultedPrintsRequest& request,
                                 const std::vector<std::string>& machines, std::size_t prints,
                                 const std::function<void(std::size_t)>& done) {
  std::vector<PoolPrint> pool(prints);
  const std::vector<std::string> see = seeing(machines);
  std::filesystem::create_directories(request.folder / "programs");
  std::filesystem::create_directories(request.folder / "machines");
  in_parallel(
      prints, request.threads,
      [&](std::size_t i) {
        const std::vector<std::string>& turns = !see.empty() && i % kPrintsPerBlock == 0 ? see : machines;
        pool[i] = make_pool_print(turns[i / kPrintsPerBlock % turns.size()], request.seed, i, request.folder);
      },
      [&](std::size_t, std::size_t finished) { done(finished); });
  return pool;
}

/// The print of a run: of the fault's block, one that can have the fault.
const PoolPrint& print_of(const std::vector<PoolPrint>& pool, std::size_t run) {
  const std::size_t first = kPrintsPerBlock * (run / block_size());
  const DrawnFaultKind& kind = kind_of(run);
  const bool second = kind.of_machine || run % block_size() == 1;
  const PoolPrint& wanted = pool[first + (second ? 1 : 0)];
  return can_have(wanted.machine, kind) ? wanted : pool[first + (second ? 0 : 1)];
}

std::string draw_gap_control(const PoolPrint& print, const DrawnFaultKind& kind, Random& random) {
  if (!print.machine.has_microscope) return "off";
  if (!kind.of_camera && random.uniform() < 0.2) return "off";
  return random.uniform() < 0.5 ? "start" : "continuous";
}

/// All that is drawn of a run, before anything runs.
struct DrawnRun {
  FaultedPrint run;
  RehearsalRequest request;
};

DrawnRun draw_run(const FaultedPrintsRequest& study, const PoolPrint& print, std::size_t number) {
  const DrawnFaultKind& kind = kind_of(number);
  Random random(study.seed, fmt::format("run {}", number));
  DrawnRun drawn;
  FaultedPrint& run = drawn.run;
  run.number = static_cast<int>(number);
  run.fault = kind.word;
  run.machine = print.machine.name;
  run.print = print.what;
  run.program = print.program;
  run.as_built = print.as_built;
  run.seed = print.world.value_or(random.bits() % 1'000'000);
  run.gap_control = draw_gap_control(print, kind, random);
  const double end = print.duration + (run.gap_control == "off" ? 0 : kApproachTime * print.approaches);
  run.fault_words = draw_fault_words(kind, end, print.machine, random);
  const std::string folder = study.named.empty() ? study.folder.string() : study.named;
  const auto below = [](const std::string& outer, const std::string& file) {
    return (std::filesystem::path(outer) / file).string();
  };
  run.command = fmt::format(
      "understudy rehearse {} --machine {}{} --engine quasistatic --as-built {} --seed {} --gap-control {}{} "
      "--no-pictures --out replay",
      below(folder, print.program),
      print.own_machine ? below(folder, print.machine_word) : print.machine_word,
      print.fixture.empty() ? "" : " --fixture " + print.fixture, run.as_built, run.seed, run.gap_control,
      run.fault_words.empty() ? "" : fmt::format(" --fault '{}'", run.fault_words));
  RehearsalRequest& request = drawn.request;
  request.program = (study.folder / print.program).string();
  request.machine = print.own_machine ? (study.folder / print.machine_word).string() : print.machine_word;
  request.fixture = print.fixture;
  request.engine = "quasistatic";
  request.as_built = run.as_built;
  request.seed = run.seed;
  request.gap_control = run.gap_control;
  request.compare_without_gap_control = false;
  if (!run.fault_words.empty()) rehearsal::add_fault(run.fault_words, request);
  return drawn;
}

/// Of what the findings say stopped it: a GapStop, a cut of the power, or something else.
int stop_in(const Record& record) {
  for (const rehearsal::Finding& finding : record.findings) {
    if (finding.about != rehearsal::kStopped) continue;
    for (int stop = static_cast<int>(GapStop::port_failed); stop > 0; --stop)
      if (finding.message.find(fmt::format("{}", to_string(static_cast<GapStop>(stop)))) != std::string::npos)
        return stop;
    return finding.message.find("power cut") != std::string::npos ? kPowerStop : kOtherStop;
  }
  return kNoStop;
}

std::string stop_word(int stop) {
  if (stop == kNoStop) return "";
  if (stop == kPowerStop) return "power cut";
  return stop == kOtherStop ? "other" : to_string(static_cast<GapStop>(stop));
}

bool names(const DrawnFaultKind& kind, int stop) {
  if (stop == kPowerStop) return kind.word == to_string(sim::FaultKind::power_cut);
  return std::find(kind.named_by.begin(), kind.named_by.end(), static_cast<GapStop>(stop)) !=
         kind.named_by.end();
}

RunJournal::Answer numbers_of(bool go, int stop, const PrintTruth& t) {
  return {go ? 1.0 : 0.0,
          static_cast<double>(stop),
          static_cast<double>(t.flaws),
          t.tip_max,
          t.orientation_max,
          t.missing,
          t.too_low,
          t.too_high,
          t.gap_min,
          t.gap_max};
}

void take(const RunJournal::Answer& numbers, FaultedPrint& run) {
  const int stop = static_cast<int>(numbers.at(1));
  run.stop = stop_word(stop);
  run.truth = {static_cast<unsigned>(numbers.at(2)),
               numbers.at(3),
               numbers.at(4),
               numbers.at(5),
               numbers.at(6),
               numbers.at(7),
               numbers.at(8),
               numbers.at(9)};
  run.answer =
      answer_of(numbers.at(0) != 0, names(kind_of(static_cast<std::size_t>(run.number)), stop), run.truth);
}

/// Nothing, and why, where it could not be run.
std::optional<RunJournal::Answer> rehearse_run(const DrawnRun& drawn, const IntendedPrint& intended,
                                               std::string& why) {
  try {
    const Record record = rehearsal::rehearse(drawn.request);
    return numbers_of(record.go, stop_in(record), judge_print(intended, record));
  } catch (const MachineError& error) {
    why = error.what();
  } catch (const InputError& error) {
    why = error.what();
  }
  return std::nullopt;
}

void require(const FaultedPrintsRequest& request) {
  if (request.runs < 1 || request.runs > kRunsMax)
    throw InputError(fmt::format("--runs {} is outside 1..{}", request.runs, kRunsMax));
  for (const std::string& name : request.machines)
    if (!machine::load_machine(name).tool.prints())
      throw InputError(fmt::format("machine {}: its tool does not print", name));
}

}  // namespace

const char* to_string(PrintAnswer answer) {
  switch (answer) {
    case PrintAnswer::good_go:
      return "go, good";
    case PrintAnswer::silent:
      return "go, spoilt";
    case PrintAnswer::named:
      return "stopped, named";
    case PrintAnswer::spoilt_no:
      return "no-go, spoilt";
    case PrintAnswer::cautious:
      return "no-go, good";
    case PrintAnswer::not_run:
      return "not run";
  }
  return "unknown";
}

PrintAnswer answer_of(bool go, bool stop_names_fault, const PrintTruth& truth) {
  if (go) return truth.spoilt() ? PrintAnswer::silent : PrintAnswer::good_go;
  if (stop_names_fault) return PrintAnswer::named;
  return truth.spoilt() ? PrintAnswer::spoilt_no : PrintAnswer::cautious;
}

std::vector<FaultCounts> FaultedPrints::by_fault() const {
  std::vector<FaultCounts> all;
  for (const DrawnFaultKind& kind : drawn_fault_kinds()) {
    FaultCounts counts;
    counts.fault = kind.word;
    for (const FaultedPrint& run : runs)
      if (run.fault == kind.word) ++counts.runs, ++counts.answers[static_cast<std::size_t>(run.answer)];
    if (counts.runs > 0) all.push_back(std::move(counts));
  }
  return all;
}

bool FaultedPrints::good() const {
  return std::none_of(runs.begin(), runs.end(),
                      [](const FaultedPrint& run) { return run.answer == PrintAnswer::silent; });
}

FaultedPrints run_faulted_prints(const FaultedPrintsRequest& request, const Progress& progress) {
  require(request);
  FaultedPrints result;
  result.seed = request.seed;
  result.command = request.command;
  result.machines = request.machines;
  if (request.machines.empty())
    for (const std::string& name : printing_machines())
      (can_print_any(name, request.seed) ? result.machines : result.left_out).push_back(name);
  const auto count = static_cast<std::size_t>(request.runs);
  const std::size_t prints = kPrintsPerBlock * ((count + block_size() - 1) / block_size());
  result.prints = static_cast<int>(prints);
  const auto tell = [&](double done, const std::string& what) {
    if (progress) progress(done / static_cast<double>(count + prints), what);
  };
  const std::vector<PoolPrint> pool = make_pool(request, result.machines, prints, [&](std::size_t finished) {
    tell(static_cast<double>(finished), fmt::format("print {} of {}", finished, prints));
  });
  result.runs.resize(count);
  const auto run_one = [&](std::size_t i) {
    const PoolPrint& print = print_of(pool, i);
    const DrawnRun drawn = draw_run(request, print, i);
    result.runs[i] = drawn.run;
    const auto numbers = rehearse_run(drawn, *print.intended, result.runs[i].why);
    if (numbers) take(*numbers, result.runs[i]);
    return numbers;
  };
  RunJournal journal(request.journal,
                     request.journal.empty()
                         ? ""
                         : fmt::format("faulted prints of {}, seed {}, machines {}", kVersion, request.seed,
                                       fmt::join(result.machines, " ")));
  if (!request.journal.empty()) journal.confirm(run_one(0).value_or(RunJournal::Answer{}));
  in_parallel(
      count, request.threads,
      [&](std::size_t i) {
        stop_if_interrupted();
        if (const auto known = journal.find(i); known && !known->empty()) {
          result.runs[i] = draw_run(request, print_of(pool, i), i).run;
          take(*known, result.runs[i]);
        } else if (const auto numbers = run_one(i)) {
          journal.add(i, *numbers);
        }
      },
      [&](std::size_t, std::size_t done) {
        tell(static_cast<double>(prints + done), fmt::format("run {} of {}", done, count));
      });
  journal.remove();
  return result;
}

}  // namespace understudy::studies
