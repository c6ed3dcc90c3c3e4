#include "report/page/faulted_twin_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "studies/gap/injected_fault.h"

namespace understudy::report {
namespace {

using studies::ConfusionCell;
using studies::FaultedTask;
using studies::FaultedTrial;
using studies::FaultedTwin;
using studies::Judgement;
using studies::PlantTrials;
using Json = nlohmann::ordered_json;

constexpr const char* kWhat = "faulted twin";
constexpr std::size_t kWrongListed = 40;

Json number(double value) { return std::isfinite(value) ? Json(stable_number(value, kWhat)) : Json(nullptr); }

std::string task_text(const FaultedTwin& faulted) {
  return faulted.task == FaultedTask::approach ? "Faulted approaches" : "Faulted prints";
}

bool wrong(const FaultedTrial& trial) {
  return trial.judgement != Judgement::right && trial.judgement != Judgement::not_in_play;
}

std::string cell_text(const ConfusionCell& cell) {
  const int count = cell.right + cell.wrong;
  if (count == 0) return "";
  return cell.wrong == 0 ? std::to_string(count) : fmt::format("{} ({} wrong)", count, cell.wrong);
}

/// Every answer that was given: the good one first.
std::vector<std::string> answers_of(const std::vector<ConfusionCell>& cells, const std::string& good) {
  std::vector<std::string> answers{good};
  for (const ConfusionCell& cell : cells)
    if (std::find(answers.begin(), answers.end(), cell.answer) == answers.end())
      answers.push_back(cell.answer);
  std::sort(answers.begin() + 1, answers.end());
  return answers;
}

WordTable confusion_table(const FaultedTwin& faulted) {
  const PlantTrials& first = faulted.plants.front();
  const auto cells = confusion(first.trials);
  const auto answers = answers_of(cells, faulted.task == FaultedTask::approach ? "reached" : "completed");
  WordTable t{
      task_text(faulted) + " on the whole twin, " + to_string(first.plant),
      "Each trial has one fault; a column is what the controller answered. Not in play: the fault came "
      "too late, or changed nothing that can be seen.",
      {"fault", "trials", "not in play"},
      1,
      {}};
  t.head.insert(t.head.end(), answers.begin(), answers.end());
  for (const studies::FaultType& type : studies::fault_types()) {
    std::vector<std::string> row(answers.size());
    int trials = 0, not_in_play = 0;
    for (const ConfusionCell& cell : cells) {
      if (cell.fault != type.name) continue;
      trials += cell.right + cell.not_in_play + cell.wrong;
      not_in_play += cell.not_in_play;
      const auto column = std::find(answers.begin(), answers.end(), cell.answer) - answers.begin();
      row[static_cast<std::size_t>(column)] = cell_text(cell);
    }
    row.insert(row.begin(), {type.name, std::to_string(trials), std::to_string(not_in_play)});
    if (trials > 0) t.rows.push_back(std::move(row));
  }
  return t;
}

WordTable wrong_table(const FaultedTwin& faulted) {
  WordTable t{
      task_text(faulted) + ": wrong answers",
      "Least and last gap are true.",
      {"plant", "trial", "machine", "surface", "fault", "answer", "judged", "least um", "last um", "stop"},
      10,
      {}};
  for (const PlantTrials& on : faulted.plants)
    for (const FaultedTrial& trial : on.trials)
      if (wrong(trial) && t.rows.size() < kWrongListed)
        t.rows.push_back({to_string(on.plant), std::to_string(trial.number), std::to_string(trial.world),
                          trial.surface, trial.words, trial.answer, to_string(trial.judgement),
                          digits(to_um(trial.least_gap), 1), digits(to_um(trial.last_gap), 1), trial.why});
  return t;
}

WordTable unsound_table(const FaultedTwin& faulted) {
  WordTable t{task_text(faulted) + fmt::format(": left out, of {} built machines", faulted.worlds),
              "Without any fault these do not end well.",
              {"machine", "surface", "why"},
              3,
              {}};
  for (const studies::UnsoundWorld& world : faulted.unsound)
    t.rows.push_back({std::to_string(world.world), world.surface, world.why});
  return t;
}

double least_gap(const PlantTrials& on) {
  double least = HUGE_VAL;
  for (const FaultedTrial& trial : on.trials) least = std::min(least, trial.least_gap);
  return least;
}

WordTable plant_table(const FaultedTwin& faulted) {
  WordTable t{
      task_text(faulted) + ": plants",
      "Least gap: of all nozzle to all part, of all trials. The last columns compare trial by trial with "
      "the first plant: other answers, and by how much the least gap differs where answers are equal.",
      {"plant", "trials", "right", "not in play", "wrong reason", "not found out", "touched", "least gap um",
       "other answers", "gap differs um", "95 %", "most"},
      1,
      {}};
  for (const PlantTrials& on : faulted.plants) {
    const auto& d = on.difference;
    t.rows.push_back(
        {to_string(on.plant), std::to_string(on.trials.size()), std::to_string(on.count(Judgement::right)),
         std::to_string(on.count(Judgement::not_in_play)), std::to_string(on.count(Judgement::wrong_reason)),
         std::to_string(on.count(Judgement::not_found)), std::to_string(on.count(Judgement::touched)),
         digits(to_um(least_gap(on)), 1), std::to_string(d.other_answers), digits(to_um(d.gap_median), 1),
         digits(to_um(d.gap_p95), 1), digits(to_um(d.gap_max), 1)});
  }
  return t;
}

Json trial_value(const FaultedTrial& trial) {
  return {{"trial", trial.number},
          {"machine_seed", std::to_string(trial.world)},
          {"surface", trial.surface},
          {"fault", trial.fault},
          {"words", trial.words},
          {"answer", trial.answer},
          {"judgement", to_string(trial.judgement)},
          {"least_gap_um", number(to_um(trial.least_gap))},
          {"last_gap_um", number(to_um(trial.last_gap))},
          {"why", trial.why}};
}

Json plant_value(const PlantTrials& on) {
  Json value{{"plant", to_string(on.plant)}, {"trials", on.trials.size()}};
  for (const Judgement j : {Judgement::right, Judgement::not_in_play, Judgement::wrong_reason,
                            Judgement::not_found, Judgement::touched})
    value["judgements"][to_string(j)] = on.count(j);
  value["least_gap_um"] = number(to_um(least_gap(on)));
  value["difference"] = {{"other_answers", on.difference.other_answers},
                         {"gap_um",
                          {{"median", number(to_um(on.difference.gap_median))},
                           {"p95", number(to_um(on.difference.gap_p95))},
                           {"max", number(to_um(on.difference.gap_max))}}}};
  value["confusion"] = Json::array();
  for (const ConfusionCell& cell : confusion(on.trials))
    value["confusion"].push_back({{"fault", cell.fault},
                                  {"answer", cell.answer},
                                  {"right", cell.right},
                                  {"not_in_play", cell.not_in_play},
                                  {"wrong", cell.wrong}});
  value["wrong"] = Json::array();
  for (const FaultedTrial& trial : on.trials)
    if (wrong(trial)) value["wrong"].push_back(trial_value(trial));
  return value;
}

}  // namespace

std::vector<WordTable> faulted_twin_tables(const FaultedTwin& faulted) {
  std::vector<WordTable> tables;
  for (WordTable table :
       {confusion_table(faulted), wrong_table(faulted), plant_table(faulted), unsound_table(faulted)})
    if (!table.rows.empty()) tables.push_back(std::move(table));
  return tables;
}

Json faulted_twin_value(const FaultedTwin& faulted) {
  Json value{{"machines", faulted.worlds}};
  value["left_out"] = Json::array();
  for (const studies::UnsoundWorld& world : faulted.unsound)
    value["left_out"].push_back(
        {{"machine_seed", std::to_string(world.world)}, {"surface", world.surface}, {"why", world.why}});
  value["plants"] = Json::array();
  for (const PlantTrials& on : faulted.plants) value["plants"].push_back(plant_value(on));
  return value;
}

}  // namespace understudy::report
