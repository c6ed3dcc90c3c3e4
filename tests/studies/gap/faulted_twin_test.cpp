// Faults of picture and machine on the whole twin. The loopback suite of the same faults, by the thousand, is
// tests/control/gap/faulted_approach_test.cpp.
#include "studies/gap/faulted_twin.h"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::studies {
namespace {

FaultedTwinRequest request_for(FaultedTask task, int trials, int worlds) {
  FaultedTwinRequest request;
  request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  request.task = task;
  request.trials = trials;
  request.worlds = worlds;
  request.threads = hardware_threads();
  return request;
}

std::string words(const FaultedTrial& trial) {
  return fmt::format("trial {}, machine {}, {}, {}: {} ({}), least gap {:.1f} um, last {:.1f} um: {}",
                     trial.number, trial.world, trial.surface,
                     trial.words.empty() ? trial.fault : trial.words, trial.answer,
                     to_string(trial.judgement), to_um(trial.least_gap), to_um(trial.last_gap), trial.why);
}

struct Teeth {
  int stops = 0;    ///< at least
  int answers = 0;  ///< different ones, at least
  int wrong = 0;    ///< wrong answers, at most: those that docs/gap-control.md states
};

FaultedTwin expect_right_answers(const FaultedTwinRequest& request, const Teeth& teeth) {
  FaultedTwin result = run_faulted_twin(request);
  for (const UnsoundWorld& world : result.unsound)
    std::printf("machine %d on %s is left out: %s\n", static_cast<int>(world.world), world.surface.c_str(),
                world.why.c_str());
  for (const PlantTrials& on : result.plants) {
    for (const FaultedTrial& trial : on.trials) {
      EXPECT_GT(trial.least_gap, 0) << words(trial);
      const bool wrong = trial.judgement != Judgement::right && trial.judgement != Judgement::not_in_play;
      if (wrong) std::printf("wrong on %s: %s\n", to_string(on.plant).c_str(), words(trial).c_str());
      if (trial.stopped) {
        EXPECT_FALSE(trial.why.empty()) << words(trial);
      }
    }
    // The draw is not toothless: faults come into play, and a good part of them stops.
    int stopped = 0;
    std::set<std::string> answers;
    for (const FaultedTrial& trial : on.trials) {
      stopped += trial.stopped;
      answers.insert(trial.answer);
    }
    EXPECT_LE(on.count(Judgement::wrong_reason) + on.count(Judgement::not_found), teeth.wrong);
    EXPECT_GE(stopped, teeth.stops);
    EXPECT_GE(static_cast<int>(answers.size()), teeth.answers);
    EXPECT_LE(4 * on.count(Judgement::not_in_play), static_cast<int>(on.trials.size()));
  }
  return result;
}

TEST(FaultedTwin, AnApproachUnderEachFaultDoesNotTouchAndItsStopNamesTheFault) {
  expect_right_answers(request_for(FaultedTask::approach, 16, 1), {6, 6});
}

TEST(ExtendedFaultedTwin, PrintsDoNotTouchAndTheirStopsNameTheFault) {
  FaultedTwinRequest request = request_for(FaultedTask::print, 3, 1);
  request.faults = {"saturated", "stale", "growth"};
  expect_right_answers(request, {1, 2});
}

TEST(SlowFaultedTwin, ResultsDoNotDependOnThreads) {
  FaultedTwinRequest request = request_for(FaultedTask::approach, 3, 1);
  request.threads = 1;
  const FaultedTwin one = run_faulted_twin(request);
  request.threads = 3;
  const FaultedTwin three = run_faulted_twin(request);
  for (std::size_t i = 0; i < one.plants[0].trials.size(); ++i) {
    EXPECT_EQ(one.plants[0].trials[i].words, three.plants[0].trials[i].words);
    EXPECT_EQ(one.plants[0].trials[i].least_gap, three.plants[0].trials[i].least_gap);
    EXPECT_EQ(one.plants[0].trials[i].why, three.plants[0].trials[i].why);
  }
}

TEST(FaultedTwin, CountsEveryTrialOnceInItsConfusionTable) {
  std::vector<FaultedTrial> trials(5);
  for (FaultedTrial& trial : trials) trial.fault = "dark", trial.answer = "no dot";
  trials[1].judgement = Judgement::wrong_reason;
  trials[2].judgement = Judgement::touched;
  trials[3].answer = "reached";
  trials[3].judgement = Judgement::not_in_play;
  trials[4].fault = "none";
  trials[4].answer = "reached";
  const auto cells = confusion(trials);
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].fault, "none");
  EXPECT_EQ(cells[0].right, 1);
  EXPECT_EQ(cells[1].answer, "no dot");
  EXPECT_EQ(cells[1].right, 1);
  EXPECT_EQ(cells[1].wrong, 2);
  EXPECT_EQ(cells[2].not_in_play, 1);
}

TEST(FaultedTwin, RefusesWhatItCannotRun) {
  EXPECT_THROW(run_faulted_twin(request_for(FaultedTask::approach, 0, 1)), InputError);
  EXPECT_THROW(run_faulted_twin(request_for(FaultedTask::approach, 1, 0)), InputError);
  FaultedTwinRequest request = request_for(FaultedTask::approach, 1, 1);
  request.faults = {"darkness"};
  EXPECT_THROW(run_faulted_twin(request), InputError);
}

TEST(SlowFaultedTwin, NoneOfTwoThousandApproachesTouchesAndAtMostThreeAnswersAreWrong) {
  expect_right_answers(request_for(FaultedTask::approach, 2000, 50), {500, 7, 3});
}

TEST(SlowFaultedTwin, NoneOfTwoHundredPrintsTouchesAndAtMostThreeAnswersAreWrong) {
  expect_right_answers(request_for(FaultedTask::print, 200, 20), {50, 7, 3});
}

TEST(SlowFaultedTwin, EnginesAndTimeStepsAnswerAlike) {
  FaultedTwinRequest request = request_for(FaultedTask::approach, 16, 1);
  request.plants = {plant_choice("mujoco:0.5"), plant_choice("mujoco:0.1"), plant_choice("bullet:0.5")};
  const FaultedTwin result = expect_right_answers(request, {6, 6});
  for (const PlantTrials& on : result.plants)
    EXPECT_LE(on.difference.other_answers, 1) << to_string(on.plant);
}

}  // namespace
}  // namespace understudy::studies
