// Bytes as a URDF.
#include <cmath>

#include "tests/fuzz/chain_check.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("arm.urdf");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  machine::UrdfArm arm;
  if (!fuzz::accepts(size, file, [&] { arm = machine::read_urdf(file, "base", "tool"); })) return 0;
  fuzz::require(arm.chain.size() > 0 && arm.chain.size() <= kinematics::kMaxAxes,
                "a number of axes that is none");
  fuzz::require_finite(arm.chain.X_OT_zero, "tool");
  fuzz::require_finite(arm.chain.X_OS_zero, "work");
  for (const kinematics::ChainAxis& axis : arm.chain.axes) {
    fuzz::require_finite(axis.point, "point of an axis");
    fuzz::require_near(axis.direction.norm(), 1, 1e-9, 0, "length of an axis' direction");
    fuzz::require(axis.lower < axis.upper, "a range that is empty");
  }
  for (const machine::LinkMass& link : arm.links) {
    fuzz::require(std::isfinite(link.mass) && link.mass >= 0, "a mass that is none");
    fuzz::require_finite(link.centre_O, "centre of mass");
    fuzz::require(link.inertia_O.allFinite(), "an inertia that is not finite");
  }
  fuzz::check_urdf_of(arm.chain, arm.links, arm.drives);
  return 0;
}
