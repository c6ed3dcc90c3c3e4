#include "toolpath/planners/section_rows.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/planners/section_curve.h"
#include "toolpath/planners/tilt_clip.h"

namespace understudy::toolpath {
namespace {

constexpr int kMostRows = 10000;

}  // namespace

std::vector<std::vector<Vec3>> section_rows(const geometry::Mesh& mesh, const SectionRows& rows) {
  check_within("number of rows", rows.count, 1, kMostRows, "rows");
  if (rows.count > 1) check_positive("pitch of the rows", to_mm(rows.pitch), "mm");
  std::vector<std::vector<Vec3>> curves;
  for (int i = 0; i < rows.count; ++i) {
    const Vec3 point = rows.point + (i - 0.5 * (rows.count - 1)) * rows.pitch * rows.normal;
    try {
      const auto section = section_curve(mesh, point, rows.normal, Vec3::UnitZ());
      curves.push_back(clip_by_tilt(mesh, section, rows.tilt_min, rows.tilt_max, rows.normal));
    } catch (const InputError& error) {
      if (rows.count == 1) throw;
      throw InputError(
          fmt::format("row {} of {}, through {}: {}", i + 1, rows.count, in_mm(point), error.what()));
    }
    if (i % 2 == 1) std::reverse(curves.back().begin(), curves.back().end());
    tell(rows.progress, curves.size(), static_cast<std::size_t>(rows.count), "cutting rows");
  }
  return curves;
}

}  // namespace understudy::toolpath
