#include "rehearsal/request/fault_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& words) {
  RehearsalRequest request;
  try {
    add_fault(words, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FaultWords, AreThoseOfScenariosWithOrWithoutBraces) {
  RehearsalRequest request;
  add_fault("{fault: stall, axis: l3, at_s: 4.15, for_s: 0.4}", request);
  add_fault("fault: thermal_growth, axis: j2, at_s: 1, over_s: 2, growth_arcmin: -3", request);
  add_fault("{fault: ghost, at_s: 5, gap_offset_um: 40, share: 0.25}", request);
  ASSERT_EQ(request.faults.size(), 2u);
  ASSERT_EQ(request.camera_faults.size(), 1u);
  EXPECT_EQ(request.faults[0].event.kind, sim::FaultKind::stall);
  EXPECT_EQ(request.faults[0].axis, "l3");
  EXPECT_EQ(request.faults[0].event.time, 4.15);
  EXPECT_EQ(request.faults[0].event.duration, 0.4);
  EXPECT_DOUBLE_EQ(request.faults[1].event.amount, -0.05 * kDegree);
  EXPECT_TRUE(request.faults[1].angle);
  EXPECT_EQ(request.camera_faults[0].event.kind, sim::CameraFaultKind::ghost);
  EXPECT_DOUBLE_EQ(request.camera_faults[0].event.gap_offset, 40e-6);
  EXPECT_EQ(request.camera_faults[0].event.share, 0.25);
}

TEST(FaultWords, AreReadStrictly) {
  EXPECT_THAT(error_of("{fault: stal, axis: l3, at_s: 1, for_s: 1}"),
              testing::AllOf(HasSubstr("--fault"), HasSubstr("did you mean 'stall'?")));
  EXPECT_THAT(error_of("{fault: stall, axis: l3, at_s: 1}"), HasSubstr("'for_s' is missing"));
  EXPECT_THAT(error_of("{fault: dark, axis: l3, at_s: 1}"), HasSubstr("unknown key 'axis'"));
  EXPECT_THAT(error_of("{fault: dark, at_s: -1}"), HasSubstr("at_s is -1 s, below 0 s"));
  EXPECT_THAT(error_of("at_s: 1"), HasSubstr("'fault' is missing"));
  EXPECT_THAT(error_of(""), HasSubstr("--fault"));
  EXPECT_THAT(error_of("stall"), HasSubstr("--fault"));
  EXPECT_THAT(error_of("{fault: dark, at_s: 1"), HasSubstr("--fault"));
}

TEST(FaultWords, OfMachineAndCameraAreDifferent) {
  for (const std::string& word : machine_fault_words())
    EXPECT_THAT(camera_fault_words(), testing::Not(testing::Contains(word)));
}

}  // namespace
}  // namespace understudy::rehearsal
