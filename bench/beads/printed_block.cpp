#include "bench/beads/printed_block.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace understudy::sim {
namespace {

std::array<float, 3> narrow(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

PrintedBlock printed_block(std::size_t beads, double tilt, std::uint64_t seed) {
  Random random(seed, "printed block");
  PrintedBlock block;
  const double path = 0.75e-3 * static_cast<double>(beads);
  block.side = std::cbrt(3 * path * kLineWidth * kLayerHeight);
  block.X_WS = make_pose(exp_rotation(Vec3(tilt, 0, 0)), Vec3(0, 0, block.side * std::sin(tilt)));
  const Vec3 up = block.X_WS.linear().col(2);
  const int lines = std::max(1, static_cast<int>(block.side / kLineWidth));
  double time = 0;
  for (int layer = 0; block.beads.size() < beads; ++layer) {
    block.height = layer * kLayerHeight;
    const double z = (layer + 0.5) * kLayerHeight;
    for (int line = 0; line < lines; ++line) {
      const double across = (line + 0.5) * kLineWidth - block.side / 2, way = line % 2 == 0 ? 1 : -1;
      for (double s = 0; s < block.side && block.beads.size() < beads;) {
        const double end = std::min(block.side, s + random.uniform(0.5e-3, 1e-3));
        const auto place = [&](double along) {
          const double x = way * (along - block.side / 2);
          return block.X_WS * (layer % 2 == 0 ? Vec3(x, across, z) : Vec3(across, x, z));
        };
        time += (end - s) / 50e-3;
        Bead bead;
        bead.from_W = narrow(place(s));
        bead.to_W = narrow(place(end));
        bead.up_W = narrow(up);
        bead.width = static_cast<float>(kLineWidth);
        bead.height = static_cast<float>(kLayerHeight);
        bead.laid_at = static_cast<float>(time);
        bead.line = static_cast<int>(block.beads.size());
        block.beads.push_back(bead);
        s = end;
      }
    }
  }
  return block;
}

}  // namespace understudy::sim
