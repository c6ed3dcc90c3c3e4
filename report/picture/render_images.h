// Single pictures with their truth, as cameras of the twin see them: what vision code is tried on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/frames.h"
#include "machine/default_machine.h"

namespace understudy::report {

struct RenderRequest {
  std::string kind = "scene";                      ///< laser, chessboard, targets, scene
  std::string machine = machine::kDefaultMachine;  ///< name or path
  std::optional<Pose>
      X_WT;        ///< true pose of the tool; else home, and for laser over the table at the gap's aim
  int camera = 0;  ///< 0 or 1, of chessboard and targets
  int layer = 5;   ///< 0 to 10, of chessboard
  std::uint64_t seed = 1;  ///< of noise and surface
  std::string command;
};

struct RenderedImage {
  std::string png;    ///< bytes
  std::string truth;  ///< JSON, schema "understudy.image/1"
};

/// Equal requests give equal bytes. Throws InputError for a machine without what is asked for or a pose that
/// it cannot take, MachineError where nothing can be rendered.
RenderedImage render_image(const RenderRequest& request);

}  // namespace understudy::report
