#include "report/study/faulted_prints_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using studies::FaultCounts;
using studies::FaultedPrint;
using studies::FaultedPrints;
using studies::PrintAnswer;
using Json = nlohmann::ordered_json;

Json number(double value) { return stable_number(value, "faulted prints"); }

/// In double quotes, those inside doubled.
std::string csv_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string line_of(const FaultCounts& counts) {
  std::string line = fmt::format("{:<16}{:>6}", counts.fault, counts.runs);
  for (const int count : counts.answers) line += fmt::format("{:>16}", count);
  return line + '\n';
}

Json run_value(const FaultedPrint& run) {
  const studies::PrintTruth& truth = run.truth;
  Json value{{"number", run.number},
             {"fault", run.fault},
             {"fault_words", run.fault_words},
             {"machine", run.machine},
             {"print", run.print},
             {"program", run.program},
             {"as_built", run.as_built},
             {"seed", run.seed},
             {"gap_control", run.gap_control},
             {"answer", to_string(run.answer)},
             {"stop", run.stop},
             {"flaws", studies::flaw_words(truth.flaws)},
             {"tip_max_um", number(to_um(truth.tip_max))},
             {"orientation_max_mrad", number(1e3 * truth.orientation_max)},
             {"missing_mm", number(to_mm(truth.missing))},
             {"too_low_mm", number(to_mm(truth.too_low))},
             {"too_high_mm", number(to_mm(truth.too_high))},
             {"command", run.command}};
  if (!run.why.empty()) value["why"] = run.why;
  return value;
}

}  // namespace

std::string faulted_prints_table(const FaultedPrints& prints) {
  std::string table = fmt::format("{} runs of {} prints, seed {}\n{:<16}{:>6}", prints.runs.size(),
                                  prints.prints, prints.seed, "fault", "runs");
  for (int answer = 0; answer < studies::kPrintAnswers; ++answer)
    table += fmt::format("{:>16}", to_string(static_cast<PrintAnswer>(answer)));
  table += '\n';
  FaultCounts all;
  all.fault = "all";
  for (const FaultCounts& counts : prints.by_fault()) {
    table += line_of(counts);
    all.runs += counts.runs;
    for (std::size_t i = 0; i < counts.answers.size(); ++i) all.answers[i] += counts.answers[i];
  }
  table += line_of(all);
  if (!prints.left_out.empty())
    table += fmt::format("left out: {}: none of what is drawn is within their limits\n",
                         fmt::join(prints.left_out, ", "));
  for (const FaultedPrint& run : prints.runs)
    if (run.answer == PrintAnswer::silent)
      table += fmt::format("go on a spoilt part ({}): run {}\n  {}\n", studies::flaw_words(run.truth.flaws),
                           run.number, run.command);
  return table;
}

std::string faulted_prints_json(const FaultedPrints& prints) {
  Json json;
  json["schema"] = "understudy.faulted-prints/1";
  json["seed"] = prints.seed;
  json["machines"] = prints.machines;
  json["left_out"] = prints.left_out;
  json["prints"] = prints.prints;
  json["faults"] = Json::array();
  for (const FaultCounts& counts : prints.by_fault()) {
    Json row{{"fault", counts.fault}, {"runs", counts.runs}};
    for (int answer = 0; answer < studies::kPrintAnswers; ++answer)
      row[to_string(static_cast<PrintAnswer>(answer))] = counts.of(static_cast<PrintAnswer>(answer));
    json["faults"].push_back(std::move(row));
  }
  json["runs"] = Json::array();
  for (const FaultedPrint& run : prints.runs) json["runs"].push_back(run_value(run));
  json["provenance"] = {{"version", kVersion}, {"command", prints.command}};
  return to_text(json, 2) + "\n";
}

std::string faulted_prints_csv(const FaultedPrints& prints) {
  std::string csv =
      "number,fault,machine,print,as_built,seed,gap_control,answer,stop,flaws,tip_max_um,orientation_max_"
      "mrad,"
      "missing_mm,too_low_mm,too_high_mm,gap_min_mm,gap_max_mm,why,command\n";
  for (const FaultedPrint& run : prints.runs) {
    const studies::PrintTruth& truth = run.truth;
    csv +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{:.3f},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{},{}\n",
                    run.number, run.fault, run.machine, run.print, run.as_built, run.seed, run.gap_control,
                    csv_text(to_string(run.answer)), run.stop, csv_text(studies::flaw_words(truth.flaws)),
                    to_um(truth.tip_max), 1e3 * truth.orientation_max, to_mm(truth.missing),
                    to_mm(truth.too_low), to_mm(truth.too_high), to_mm(truth.gap_min), to_mm(truth.gap_max),
                    csv_text(run.why), csv_text(run.command));
  }
  return csv;
}

}  // namespace understudy::report
