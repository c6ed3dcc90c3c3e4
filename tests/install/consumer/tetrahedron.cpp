// The volume and a distance of a tetrahedron of 30 mm on the axes: a sixth of the cube; the slanted face.
#include <cmath>
#include <cstdio>
#include <exception>

#include "geometry/mesh.h"

int main() try {
  using namespace understudy;
  const double a = 0.03;
  const geometry::Mesh mesh({Vec3(0, 0, 0), Vec3(a, 0, 0), Vec3(0, a, 0), Vec3(0, 0, a)},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const double distance = mesh.nearest(Vec3(a, a, a)).distance;
  std::printf("volume %.1f mm3, distance %.3f mm\n", 1e9 * mesh.volume(), 1e3 * distance);
  return std::abs(mesh.volume() - a * a * a / 6) < 1e-12 && std::abs(distance - 2 * a / std::sqrt(3.0)) < 1e-9
             ? 0
             : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
