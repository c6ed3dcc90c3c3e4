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
  geometry::Shape shape;          ///< X_FS is the pose in W
  std::array<float, 3> colour{};  ///< linear RGB 0..1
  bool outlined = true;           ///< its sharp edges are drawn
};

/// A closed surface that says its normals itself, such as that of many thousands of beads: nothing is looked
/// for in it and nothing smoothed.
struct SmoothSurface {
  std::vector<Vec3> vertices;                 ///< in F [m]
  std::vector<Vec3> normals;                  ///< in F, unit, one a vertex
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise outside
  std::array<float, 3> colour{};              ///< linear RGB 0..1
  Pose X_WF = Pose::Identity();
};

/// A line in space, drawn as a round tube: a tool path, a bead, a beam.
struct Polyline {
  std::vector<Vec3> points;       ///< in W
  std::array<float, 3> colour{};  ///< linear RGB 0..1
  double radius = 0;              ///< [m]
};

struct PictureScene {
  std::vector<ColouredShape> shapes;
  std::vector<SmoothSurface> surfaces;
  std::vector<Polyline> polylines;
  Vec3 eye_W{0, 0, 0};
  Vec3 target_W{0, 0, 0};
  Vec3 up_W{0, 0, 1};
  double field_of_view = 0.6;      ///< [rad], vertical
  int width = 1280, height = 960;  ///< [px]
  std::array<float, 3> background{1, 1, 1};
};

/// 8-bit RGB, row-major, top row first.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Lit by the sky and one lamp, anti-aliased, with creases drawn and a soft shadow on a ground below the
/// lowest shape. Equal scenes give equal bytes. Throws MachineError when no OSMesa context can be made,
/// InputError for a picture without size or a camera that looks nowhere.
Picture render_picture(PictureScene scene);

}  // namespace understudy::renderer
