#include "rehearsal/inspection/place_on_table.h"

#include <cmath>
#include <variant>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

constexpr double kMostOffTable = 0.2e-3;  // [m], by which the first layer may lie under the table

double thousandths(double metres) { return std::round(1e3 * to_mm(metres)) / 1e3; }

}  // namespace

std::array<double, 3> place_on_table(const toolpath::Extent& printed, const toolpath::Extent& part,
                                     const machine::MachineDescription& machine, double layer, bool lowered) {
  std::array<double, 3> place{0, 0, 0};
  const Vec3 &lower = printed.lower, &upper = printed.upper;
  if (lower.z() < -kMostOffTable || (lowered && lower.z() > kFarAbove))
    place[2] = thousandths(layer - lower.z());
  const auto* table = std::get_if<geometry::Box>(&machine.table.form);
  if (table == nullptr) return place;
  const Vec3 half = table->size / 2, middle = machine.table.X_FS.translation();
  const auto leaves = [&](int i) { return lower[i] < middle[i] - half[i] || upper[i] > middle[i] + half[i]; };
  if (!leaves(0) && !leaves(1)) return place;
  const Vec3 centre = (part.lower + part.upper) / 2;
  for (int i = 0; i < 2; ++i) place[static_cast<std::size_t>(i)] = thousandths(middle[i] - centre[i]);
  return place;
}

}  // namespace understudy::rehearsal
