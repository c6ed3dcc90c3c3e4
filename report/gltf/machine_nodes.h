// The machine's bodies as nodes of a scene, moved as the record says.
#pragma once

#include "report/gltf/gltf_scene.h"
#include "report/page/recorded_replay.h"

namespace understudy::report {

/// The frames that bodies hang in, as nodes.
struct FrameNodes {
  int machine = 0;  ///< O where axes move the table, else W
  int work = 0;     ///< W
};

struct MotionSettings {
  double within = 10e-6;  ///< [m], by which no point of a body is off what the record says at its instants
  double speed = 1;
};

/// "machine" and, below it, "work".
FrameNodes add_frames(const RecordedReplay& replay, const MotionSettings& settings, int top,
                      GltfScene& scene);
/// Bodies below these, tool, table and part.
void add_machine(const RecordedReplay& replay, const MotionSettings& settings, const FrameNodes& frames,
                 GltfScene& scene);

}  // namespace understudy::report
