#include "report/picture/bead_surface.h"

#include <utility>

#include "report/picture/body_colours.h"

namespace understudy::report {

renderer::SmoothSurface bead_surface(sim::SweptShell shells) {
  renderer::SmoothSurface surface;
  surface.vertices = std::move(shells.mesh.vertices);
  surface.normals = std::move(shells.normals);
  surface.triangles = std::move(shells.mesh.triangles);
  surface.colour = kFilament;
  return surface;
}

}  // namespace understudy::report
