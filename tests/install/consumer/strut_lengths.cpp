// Inverse kinematics of a shipped machine: its struts' lengths at home.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

#include "machine/description.h"

int main() try {
  using namespace understudy;
  const machine::MachineDescription machine = machine::load_machine(HEXAPOD);
  const auto mechanism = machine.make_mechanism();
  std::array<double, 6> lengths{};
  if (mechanism->inverse(machine.X_BT_home, {}, lengths) != kinematics::SolveStatus::ok) return 1;
  bool plausible = true;
  for (int strut = 0; strut < 6; ++strut) {
    const double length = lengths[static_cast<std::size_t>(strut)];
    const auto range = mechanism->axis_range(strut);
    std::printf("%s %.3f mm\n", mechanism->axis_name(strut).c_str(), 1e3 * length);
    plausible = plausible && range.lower < length && length < range.upper;
  }
  return plausible ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
