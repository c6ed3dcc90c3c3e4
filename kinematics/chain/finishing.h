// Redundant finishing stage: a bed that lifts (z) and turns (c), and beside it an end mill on two slides and
// two turns (x, y, yaw, pitch) (Yu 2023; docs/reference.md#finishing-stage).
//
// Axes z c x y yaw pitch; the tool seen from the bed is the paper's product of exponentials (eq 2, table 1):
//   X_Sb = e^[S1 z] e^[S2 c] e^[S3 x] e^[S4 y] e^[S5 yaw] e^[S6 pitch] M,   v = -omega x q,
//   M = translation (-L3 + Le, 0, 0).
// The bed carries z and c, so it sinks by z and turns by -c. {b} has x along the end mill from its holder to
// its tip; T has z from the tip into the holder: X_bT turns by -90 degrees about y, so that z_T = -x_b,
// y_T = y_b, and x_T = z_b points up at home.
#pragma once

#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

constexpr int kFinishingAxes = 6;

struct FinishingGeometry {
  double l3 = 0;  ///< [m], from the bed's turning axis to the wrist at home
  double le = 0;  ///< [m], from the wrist to the tip of the end mill
};

Chain finishing_chain(const FinishingGeometry& geometry);

/// The redundancy in closed form: the axes that bring tip and tool axis to a pose with the bed turned by c.
/// Of the two wrists (pitch and its supplement) the one within +-90 degrees; yaw is the turn nearest to
/// `yaw_near`, and stays there where the tool is vertical and yaw is free. `bad_input` unless all is finite
/// and the pose rigid.
SolveStatus finishing_at_bed_turn(const FinishingGeometry& geometry, const Pose& X_ST, double c,
                                  double yaw_near, std::span<double> axes);

}  // namespace understudy::kinematics
