#include "tests/fuzz/chain_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "machine/file/urdf_writer.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

double mass_of(std::span<const machine::LinkMass> links) {
  return std::accumulate(links.begin(), links.end(), 0.0,
                         [](double sum, const machine::LinkMass& link) { return sum + link.mass; });
}

/// [m], that lengths are rounded against.
double size_of(const kinematics::Chain& chain) {
  double size = std::max(chain.X_OT_zero.translation().norm(), chain.X_OS_zero.translation().norm());
  for (const kinematics::ChainAxis& axis : chain.axes) size = std::max(size, axis.point.norm());
  return size + 1;
}

}  // namespace

void check_urdf_of(const kinematics::Chain& chain, std::span<const machine::LinkMass> links,
                   std::span<const machine::AxisDrive> drives) {
  static const InputFile written("written.urdf");
  written.fill(machine::write_urdf("machine", chain, links, drives));
  const machine::UrdfArm read = machine::read_urdf(written.path(), "work", "tool");
  require(read.chain.size() == chain.size(), "another number of axes came back");
  // Axes come back from the base to the tool; a file may list them otherwise.
  std::vector<double> at(static_cast<std::size_t>(chain.size())), at_read(at.size());
  for (const double part : {0.0, 0.1, -0.7}) {
    for (int i = 0; i < chain.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      at[index] = part * (1 + 0.1 * i);
      const auto same = [&](const kinematics::ChainAxis& axis) {
        return axis.name == chain.axes[index].name;
      };
      const auto found = std::find_if(read.chain.axes.begin(), read.chain.axes.end(), same);
      require(found != read.chain.axes.end(), "an axis did not come back: " + chain.axes[index].name);
      at_read[static_cast<std::size_t>(found - read.chain.axes.begin())] = at[index];
    }
    const Pose w = kinematics::forward(chain, at), r = kinematics::forward(read.chain, at_read);
    require_near((r.translation() - w.translation()).norm(), 0, 1e-9 * size_of(chain), 0, "tip");
    require_near(angle_between(r.linear(), w.linear()), 0, 1e-7, 0, "turn");
  }
  require_near(mass_of(read.links), mass_of(links), 1e-9, 1e-9, "mass");
}

}  // namespace understudy::fuzz
