// Machine, part and what is printed by an instant of a replay, for the renderer.
#pragma once

#include <Eigen/Geometry>

#include "renderer/scene_view.h"
#include "report/page/recorded_replay.h"

namespace understudy::report {

/// Which bodies of the machine are drawn: all, or the tool's tip alone, which hides and shades less.
enum class ShownBodies { machine, tip };

/// What is printed is as it lies, what is still to come a line two pixels wide. No eye looks at it yet. Where
/// axes move the table, the machine stands level and the table is tilted. `time` [s]; `pixel` [m]: what one
/// shows, and by which the sides of a bead may be off.
renderer::PictureScene replay_scene(const RecordedReplay& replay, double time, double pixel,
                                    ShownBodies shown = ShownBodies::machine);

/// What was laid by then; a stretch that is being laid ends where it is.
std::vector<sim::BeadStretch> laid_by(const std::vector<sim::BeadStretch>& beads, double time);

/// Of the middles of all that was laid, in W [m]; empty without beads.
Eigen::AlignedBox3d box_of_beads(const std::vector<sim::BeadStretch>& beads);

/// From W to where replay_scene() draws at that time.
Pose drawn_from_W(const RecordedReplay& replay, double time);

/// The true pose of the tool, straight between two points of the path.
Pose tool_at(const RecordedReplay& replay, double time);

}  // namespace understudy::report
