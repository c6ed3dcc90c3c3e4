// The control cycle as the gap controller moves it in an approach.
#pragma once

#include "control/cycle.h"
#include "control/gap/gap_controller.h"

namespace understudy::control {

/// Straight moves along the tool axis for the gap controller, at the approach's own feed.
class ApproachMotion : public GapMotion {
 public:
  /// Both outlive it.
  ApproachMotion(ControlCycle& cycle, const toolpath::Step& approach) : cycle_(cycle), approach_(approach) {}

  machine::Status move_to(const Pose& X_WT) override;
  machine::MachinePort& port() override { return cycle_.port(); }

 private:
  ControlCycle& cycle_;
  const toolpath::Step& approach_;
};

}  // namespace understudy::control
