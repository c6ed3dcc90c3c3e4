#include "studies/faults/drawn_fault.h"

#include <set>

#include <gtest/gtest.h>

#include "rehearsal/request/fault_words.h"

namespace understudy::studies {
namespace {

TEST(DrawnFault, EveryFaultThatExistsIsDrawn) {
  std::set<std::string> words;
  for (const DrawnFaultKind& kind : drawn_fault_kinds()) words.insert(kind.word);
  EXPECT_EQ(words.size(), 1u + 6u + 10u);
  EXPECT_TRUE(words.contains("none"));
  for (const auto kind :
       {sim::FaultKind::lost_steps, sim::FaultKind::disconnected, sim::FaultKind::power_cut})
    EXPECT_TRUE(words.contains(to_string(kind)));
  for (int kind = 0; kind < sim::kCameraFaultKinds; ++kind)
    EXPECT_TRUE(words.contains(to_string(static_cast<sim::CameraFaultKind>(kind))));
}

TEST(DrawnFault, EveryOneIsTakenByTheMachineAndStrikesInTime) {
  for (const std::string& name : machine::machine_names()) {
    const auto machine = machine::load_machine(name);
    for (const DrawnFaultKind& kind : drawn_fault_kinds()) {
      if (!can_have(machine, kind)) continue;
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed, kind.word);
        const std::string words = draw_fault_words(kind, 7, machine, random);
        rehearsal::RehearsalRequest request;
        if (kind.word == "none") {
          EXPECT_EQ(words, "");
          continue;
        }
        rehearsal::add_fault(words, request);
        ASSERT_EQ(request.faults.size(), kind.of_machine ? 1u : 0u) << words;
        ASSERT_EQ(request.camera_faults.size(), kind.of_camera ? 1u : 0u) << words;
        EXPECT_NO_THROW(resolve_faults(request.faults, machine)) << name << ' ' << words;
        EXPECT_NO_THROW(resolve_camera_faults(request.camera_faults, machine)) << name << ' ' << words;
        const double at =
            kind.of_machine ? request.faults[0].event.time : request.camera_faults[0].event.time;
        EXPECT_GE(at, 0);
        EXPECT_LE(at, 7);
      }
    }
  }
}

TEST(DrawnFault, EqualStreamsDrawEqualWords) {
  const auto machine = machine::load_machine("hexapod");
  for (const DrawnFaultKind& kind : drawn_fault_kinds()) {
    Random one(3, kind.word), same(3, kind.word), other(4, kind.word);
    const std::string words = draw_fault_words(kind, 7, machine, one);
    EXPECT_EQ(words, draw_fault_words(kind, 7, machine, same));
    if (kind.word != "none") {
      EXPECT_NE(words, draw_fault_words(kind, 7, machine, other));
    }
  }
}

// What nobody notices and what ruins any print are both among them.
TEST(DrawnFault, SizesSpanTheirOrdersOfMagnitude) {
  const auto machine = machine::load_machine("hexapod");
  for (const DrawnFaultKind& kind : drawn_fault_kinds()) {
    if (kind.word != to_string(sim::FaultKind::thermal_growth)) continue;
    double least = 1, most = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed, kind.word);
      rehearsal::RehearsalRequest request;
      rehearsal::add_fault(draw_fault_words(kind, 7, machine, random), request);
      const double size = std::abs(request.faults[0].event.amount);
      least = std::min(least, size);
      most = std::max(most, size);
    }
    EXPECT_LT(least, 5e-6);
    EXPECT_GT(most, 1e-3);
  }
}

TEST(DrawnFault, NoAxisFallsThatTheEngineCannotPlay) {
  const auto kinds = drawn_fault_kinds();
  for (const std::string& name : machine::machine_names()) {
    const auto machine = machine::load_machine(name);
    bool holds = true;
    for (int i = 0; i < machine.make_mechanism()->axis_count(); ++i)
      holds = holds && machine.drives[static_cast<std::size_t>(i)].self_locking;
    for (const DrawnFaultKind& kind : kinds)
      if (kind.word == to_string(sim::FaultKind::power_cut)) {
        EXPECT_EQ(can_have(machine, kind), holds) << name;
      }
  }
}

}  // namespace
}  // namespace understudy::studies
