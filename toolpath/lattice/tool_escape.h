// The way of a tool from a strut that it prints to above everything built, and back.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "toolpath/lattice/lattice_sequence.h"
#include "toolpath/lattice/tool_envelope.h"

namespace understudy::toolpath {

class ToolEscape {
 public:
  ToolEscape(const ToolEnvelope& tool, double margin, double lift);

  /// From the tip at `start`, out of what is built already, the tool's axis (unit) as it prints: on along the
  /// axis as far as is needed, up first or upright first, to `lift` above the highest strut
  /// with the tool upright. The first pose is at `start`. The first such way that keeps `margin` from `built`
  /// and that `accept` takes; nothing where there is none.
  std::optional<std::vector<Pose>> find(const Vec3& start, const Vec3& axis,
                                        const std::vector<StrutBody>& built,
                                        const std::function<bool(const std::vector<Pose>&)>& accept) const;

 private:
  bool clears(const std::vector<StrutBody>& built, const ToolMotion& motion) const;
  bool turn_clears(const std::vector<StrutBody>& built, const Vec3& tip, const Vec3& axis) const;

  const ToolEnvelope& tool_;
  double margin_, lift_;
};

}  // namespace understudy::toolpath
