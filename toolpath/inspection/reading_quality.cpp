#include "toolpath/inspection/reading_quality.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kLeans = 10 * kDegree;  // an upright tool tells little of the signs of its turns
constexpr double kShortest = 1e-6;       // [m]

}  // namespace

ReadingQuality reading_quality(const Program& program, const Vec3& start_W) {
  ReadingQuality quality;
  std::vector<double> all, leaning, sections, leaning_sections;
  Vec3 tip_W = start_W;
  for (const Step& step : program.steps) {
    if (!moves(step)) continue;
    const Vec3 path = step.X_WT.translation() - tip_W;
    tip_W = step.X_WT.translation();
    const double length = path.norm();
    if (step.kind != StepKind::print) continue;
    const Vec3 axis = tool_axis(step.X_WT);
    const bool leans = axis.z() < std::cos(kLeans);
    if (step.filament > 0) {
      const double section = step.filament / std::max(length, kShortest);
      sections.push_back(section);
      if (leans) leaning_sections.push_back(section);
    }
    if (length < kShortest) continue;
    quality.longest_step = std::max(quality.longest_step, length);
    const double angle = std::asin(std::min(1.0, std::abs(path.dot(axis)) / length));
    all.push_back(angle);
    if (leans) leaning.push_back(angle);
  }
  const std::vector<double>& angles = leaning.empty() ? all : leaning;
  quality.moves = static_cast<int>(angles.size());
  if (!angles.empty()) quality.out_of_layer = quantile(angles, 0.5);
  if (sections.empty()) return quality;
  const std::vector<double>& spread = leaning_sections.empty() ? sections : leaning_sections;
  quality.bead_spread = quantile(spread, 0.9) / quantile(spread, 0.1);
  quality.filament_share = quantile(sections, 0.5);
  return quality;
}

}  // namespace understudy::toolpath
