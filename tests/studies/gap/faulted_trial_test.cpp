#include "studies/gap/faulted_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::studies {
namespace {

using control::GapStop;
using testing::HasSubstr;

constexpr machine::GapLimits kLimits{0.1e-3, 0.2e-3, 0.13e-3, 2e-3};

const FaultType& type_of(const std::string& name) {
  for (const FaultType& type : fault_types())
    if (name == type.name) return type;
  throw std::runtime_error("no fault " + name);
}

/// An approach that took its last look at 2 s, a bead of 2 mm after it, with this gap all along.
rehearsal::TwinRun run_with(GapStop stop, double gap) {
  rehearsal::TwinRun run;
  control::GapApproach approach;
  approach.outcome.stop = stop;
  approach.outcome.samples.resize(1);
  approach.outcome.samples[0].time = 2;
  approach.done_at = 2.02;
  run.result.approaches.push_back(approach);
  run.result.completed = stop == GapStop::none;
  run.result.stop.gap = stop;
  run.result.duration = 3;
  for (int i = 0; i <= 300; ++i) {
    rehearsal::TracePoint point;
    point.time = 0.01 * i;
    point.gap = gap;
    point.extruding = point.time > 2.02;
    point.path = point.extruding ? 2e-3 * (point.time - 2.02) / 0.98 : 0;
    run.trace.push_back(point);
  }
  return run;
}

Judgement judged(const std::string& fault, FaultedTask task, const rehearsal::TwinRun& run, double time = 1) {
  InjectedFault injected;
  injected.time = time;
  FaultedTrial trial;
  judge(type_of(fault), injected, task, kLimits, run, trial);
  return trial.judgement;
}

TEST(FaultedTrial, AStopIsRightWhereItsReasonNamesTheFault) {
  auto run = run_with(GapStop::no_dot, 0.5e-3);
  run.altered_frames = 1;
  for (const FaultedTask task : {FaultedTask::approach, FaultedTask::print}) {
    EXPECT_EQ(judged("dark", task, run), Judgement::right);
    EXPECT_EQ(judged("saturated", task, run), Judgement::wrong_reason);
    EXPECT_EQ(judged("none", task, run), Judgement::wrong_reason) << "a false stop";
  }
}

TEST(FaultedTrial, TooCloseIsRightWhereItIsTrue) {
  for (const FaultedTask task : {FaultedTask::approach, FaultedTask::print}) {
    auto near = run_with(GapStop::too_close, 0.07e-3), far = run_with(GapStop::too_close, 0.12e-3);
    near.altered_frames = far.altered_frames = 1;
    EXPECT_EQ(judged("frozen", task, near), Judgement::right);
    EXPECT_EQ(judged("frozen", task, far), Judgement::wrong_reason);
    EXPECT_EQ(judged("none", task, run_with(GapStop::too_close, 0.07e-3)), Judgement::wrong_reason)
        << "nothing is to lead a sound machine there";
  }
}

TEST(FaultedTrial, AStopBeforeTheFaultIsAFalseOne) {
  const auto run = run_with(GapStop::no_dot, 0.5e-3);
  EXPECT_EQ(judged("dark", FaultedTask::approach, run), Judgement::wrong_reason) << "no frame was altered";
  const auto moved = run_with(GapStop::implausible, 0.5e-3);  // ends at 3 s
  EXPECT_EQ(judged("growth", FaultedTask::approach, moved, 3.5), Judgement::wrong_reason);
  EXPECT_EQ(judged("growth", FaultedTask::approach, moved, 2.5), Judgement::right) << "after the last look";
}

TEST(FaultedTrial, WhoGoesOnIsRightWithTheTrueGapInTheBandAlone) {
  for (const FaultedTask task : {FaultedTask::approach, FaultedTask::print}) {
    auto run = run_with(GapStop::none, 0.15e-3);
    EXPECT_EQ(judged("none", task, run), Judgement::right);
    EXPECT_EQ(judged("ghost", task, run), Judgement::not_in_play);
    run.altered_frames = 3;
    EXPECT_EQ(judged("ghost", task, run), Judgement::right);
    for (const double gap : {0.09e-3, 0.21e-3}) {
      run = run_with(GapStop::none, gap);
      run.altered_frames = 3;
      EXPECT_EQ(judged("ghost", task, run), Judgement::not_found) << gap;
    }
  }
}

TEST(FaultedTrial, ThePrintIsJudgedByTheEndOfItsBead) {
  auto run = run_with(GapStop::none, 0.15e-3);
  for (auto& point : run.trace)
    if (point.path > 1.4e-3) point.gap = 0.25e-3;
  EXPECT_EQ(judged("growth", FaultedTask::print, run), Judgement::not_found);
  EXPECT_EQ(judged("growth", FaultedTask::approach, run), Judgement::right) << "its last look was at 2 s";
  EXPECT_EQ(judged("growth", FaultedTask::approach, run, 2.01), Judgement::not_in_play);
}

TEST(FaultedTrial, ATouchIsATouchWhateverWasAnswered) {
  auto grazed = run_with(GapStop::no_dot, 0.5e-3);
  grazed.altered_frames = 1;
  grazed.trace[100].gap = -1e-6;
  EXPECT_EQ(judged("dark", FaultedTask::approach, grazed), Judgement::touched);
  auto rim = run_with(GapStop::none, 0.15e-3);
  rim.collision.nozzle_clearance_mm = 0;
  EXPECT_EQ(judged("none", FaultedTask::print, rim), Judgement::touched) << "by its rim";
  auto strut = run_with(GapStop::none, 0.15e-3);
  strut.collisions.push_back({"strut 3", "part", -1e-6, Vec3::Zero(), 1, 5});
  EXPECT_EQ(judged("none", FaultedTask::print, strut), Judgement::touched);
}

TEST(PlantChoice, IsAnEngineAndAStepInMilliseconds) {
  EXPECT_EQ(plant_choice("mujoco").engine, "mujoco");
  EXPECT_EQ(plant_choice("mujoco").timestep, 0);
  EXPECT_DOUBLE_EQ(plant_choice("bullet:0.1").timestep, 0.1e-3);
  EXPECT_EQ(to_string(plant_choice("mujoco:0.5")), "mujoco:0.5");
  for (const char* words : {"mujoko", "mujoco:", "mujoco:x", "mujoco:0.1s", "mujoco:0.001", "mujoco:50"})
    EXPECT_THROW(plant_choice(words), InputError) << words;
}

}  // namespace
}  // namespace understudy::studies
