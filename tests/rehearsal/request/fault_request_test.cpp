#include "rehearsal/request/fault_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using sim::FaultKind;
using testing::AllOf;
using testing::HasSubstr;

FaultRequest request(FaultKind kind, const std::string& axis) {
  FaultRequest r;
  r.event.kind = kind;
  r.event.time = 2;
  r.event.duration = 0.5;
  r.axis = axis;
  r.place = {"s.yaml", 9, 5};
  return r;
}

std::string camera_refusal(sim::CameraFaultKind kind, double share, const std::string& machine) {
  CameraFaultRequest r{{}, {"s.yaml", 9, 5}};
  r.event.kind = kind;
  r.event.share = share;
  try {
    (void)resolve_camera_faults({r}, machine::load_machine(machine));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CameraFaultRequests, NameTheirPlaceAndNeedACamera) {
  EXPECT_EQ(camera_refusal(sim::CameraFaultKind::dark, 1, "hexapod"), "accepted");
  EXPECT_THAT(camera_refusal(sim::CameraFaultKind::dark, 0, "hexapod"),
              AllOf(HasSubstr("s.yaml:9"), HasSubstr("share 0 is not above 0")));
  EXPECT_THAT(camera_refusal(sim::CameraFaultKind::dark, 1, "finishing"),
              AllOf(HasSubstr("s.yaml:9"), HasSubstr("camera fault dark"), HasSubstr("has no camera")));
}

std::string refusal(const FaultRequest& r, const std::string& machine) {
  try {
    (void)resolve_faults({r}, machine::load_machine(machine));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FaultRequest, NamesAreResolvedInTheMachinesOrder) {
  const auto events = resolve_faults({request(FaultKind::stall, "l3"), request(FaultKind::stall, "l1")},
                                     machine::load_machine("hexapod"));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].axis, 2);
  EXPECT_EQ(events[1].axis, 0);
  EXPECT_EQ(events[0].time, 2);
}

TEST(FaultRequest, AnUnknownAxisListsTheMachinesOwn) {
  EXPECT_THAT(refusal(request(FaultKind::stall, "j1"), "hexapod"),
              AllOf(HasSubstr("s.yaml:9:5: axis 'j1' is not one of"), HasSubstr("l1, l2, l3, l4, l5, l6")));
  EXPECT_EQ(refusal(request(FaultKind::stall, "j1"), "arm"), "accepted");
}

TEST(FaultRequest, AnAmountHasTheUnitOfItsAxis) {
  FaultRequest growth = request(FaultKind::thermal_growth, "l2");
  growth.event.amount = 20e-6;
  EXPECT_EQ(refusal(growth, "hexapod"), "accepted");
  growth.angle = true;
  EXPECT_THAT(refusal(growth, "hexapod"), HasSubstr("s.yaml:9:5: axis 'l2' slides: its amount is in um"));
  growth.axis = "j2";
  EXPECT_EQ(refusal(growth, "arm"), "accepted");
  growth.angle = false;
  EXPECT_THAT(refusal(growth, "arm"), HasSubstr("axis 'j2' turns: its amount is in arcmin"));
}

TEST(FaultRequest, WhatTheMachineCannotHaveIsRefusedAtTheRequestsPlace) {
  FaultRequest early = request(FaultKind::stall, "l1");
  early.event.time = -1;
  EXPECT_THAT(refusal(early, "hexapod"), HasSubstr("s.yaml:9:5: "));
  EXPECT_EQ(refusal(request(FaultKind::power_cut, ""), "hexapod"), "accepted") << "of no axis";
}

}  // namespace
}  // namespace understudy::rehearsal
