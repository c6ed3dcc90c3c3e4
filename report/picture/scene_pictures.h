// The machine and the part as the rehearsal saw them, drawn for people.
#pragma once

#include <string>
#include <vector>

#include "rehearsal/scene.h"
#include "renderer/scene_view.h"

namespace understudy::report {

/// A picture of a report.
struct Illustration {
  std::string png;            ///< its bytes
  int width = 0, height = 0;  ///< [px]
  std::string caption;
};

/// Throws std::logic_error as encode_png() does.
Illustration illustration(const renderer::Picture& picture, std::string caption);

/// Machine and part as a whole. Throws MachineError when no OSMesa context can be made.
renderer::Picture draw_overview(const rehearsal::Scene& scene);

/// An overview of machine and part, a close-up of the tool on the path, and the part as printed where
/// something was. Throws as above.
std::vector<Illustration> draw_scene(const rehearsal::Scene& scene);

}  // namespace understudy::report
