// A picture of machine and part for people.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/frames.h"
#include "geometry/mesh.h"
#include "geometry/shape.h"

namespace understudy::renderer {

struct ColouredShape {
  geometry::Shape shape;              ///< X_FS is the pose in W
  std::array<float, 3> colour{};      ///< linear RGB 0..1
};

struct PictureScene {
  std::vector<ColouredShape> shapes;
  Vec3 eye_W{0, 0, 0};
  Vec3 target_W{0, 0, 0};
  Vec3 up_W{0, 0, 1};
  double field_of_view = 0.6;         ///< [rad], vertical
  int width = 1280, height = 960;     ///< [px]
  std::array<float, 3> background{1, 1, 1};
};

/// 8-bit RGB, row-major, top row first.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Lit, anti-aliased, with a soft ground shadow. Throws MachineError when no OSMesa context can be made.
Picture render_picture(const PictureScene& scene);

}  // namespace understudy::renderer
