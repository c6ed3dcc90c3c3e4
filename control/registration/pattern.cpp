#include "control/registration/pattern.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "control/registration/tool_clearance.h"
#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::control {
namespace {

constexpr double kApart = 3e-3;  // [m]: nearer, two places see the same waviness and speckle
constexpr double kReadingSigma =
    15e-6;                            // [m], of a reading with machine and part, by which places are weighed
constexpr double kNearPrint = 12e-3;  // [m]
constexpr double kLeanBeyond = 1 * kDegree;
constexpr double kTolerableSigmas = 4;
constexpr std::size_t kEnough = 2;  // candidates for each place
constexpr int kCandidates = 1500;   // about

/// What one place tells, in units of the tolerance.
using Row = Eigen::Matrix<double, 6, 1>;

struct Candidate {
  ProbingPlace place;
  Row row;
  double away = 0;  // [m], from what is printed
};

double distance_to_path(const PrintedRegion& region, const Vec3& p_W) {
  if (region.path_W.empty()) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& tip : region.path_W) nearest = std::min(nearest, (tip - p_W).norm());
  return nearest;
}

bool leans_too_far(const PrintedRegion& region, const Vec3& normal_W) {
  return !region.path_W.empty() && normal_W.z() < std::cos(region.lean_max + kLeanBeyond);
}

/// Those near the print: within kNearPrint, or twice that, and so on, until there are more than enough.
void keep_near(std::size_t enough, std::vector<Candidate>& candidates) {
  double within = kNearPrint;
  const auto near = [&](const Candidate& c) { return c.away <= within; };
  while (static_cast<std::size_t>(std::count_if(candidates.begin(), candidates.end(), near)) <
         std::min(candidates.size(), enough))
    within *= 2;
  std::erase_if(candidates, [&](const Candidate& c) { return !near(c); });
}

std::vector<Candidate> candidates_of(const geometry::Mesh& part, const PartTolerance& tolerance,
                                     const ProbingCheck& check, const PrintedRegion& region,
                                     std::map<std::string, int>& refusals) {
  const Vec3 centre = 0.5 * (part.lower() + part.upper());
  const Vec3 size = part.upper() - part.lower();
  const double area = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const Mat6 root = tolerance_root(tolerance, centre);
  std::vector<Candidate> candidates;
  for (const Vec3& p : cover(part, std::max(1e-3, std::sqrt(area / kCandidates)))) {
    const geometry::SurfacePoint at = part.nearest(p);
    const ProbingPlace place{at.position, at.normal, 0};
    if (leans_too_far(region, at.normal)) {
      ++refusals["the tool would lean farther than in the print"];
      continue;
    }
    if (const std::string why = check.why_not(place); !why.empty()) {
      ++refusals[why.substr(0, why.find(':'))];
      continue;
    }
    const Row row = root.transpose() * distance_row(at.position, at.normal, centre).transpose();
    candidates.push_back({place, row / kReadingSigma, distance_to_path(region, at.position)});
  }
  return candidates;
}

/// The commonest reason.
std::string commonest(const std::map<std::string, int>& refusals) {
  const auto most = std::max_element(refusals.begin(), refusals.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == refusals.end() ? "" : fmt::format("; of the others most: {}", most->first);
}

}  // namespace

PrintedRegion printed_region(const toolpath::Program& program) {
  PrintedRegion region;
  for (const toolpath::Step& step : program.steps) {
    if (step.kind != toolpath::StepKind::print) continue;
    region.path_W.push_back(step.X_WT.translation());
    region.lean_max = std::max(region.lean_max, std::acos(std::clamp(tool_axis(step.X_WT).z(), -1.0, 1.0)));
  }
  return region;
}

double largest_shift(const geometry::Mesh& part, const PartTolerance& tolerance) {
  const double arm = std::max(part.lower().norm(), part.upper().norm());
  return kTolerableSigmas * std::hypot(tolerance.position, tolerance.rotation * arm);
}

std::vector<ProbingPlace> choose_places(const geometry::Mesh& part, const PartTolerance& tolerance,
                                        const ProbingCheck& check, const PrintedRegion& region, int count) {
  std::map<std::string, int> refusals;
  std::vector<Candidate> candidates = candidates_of(part, tolerance, check, region, refusals);
  keep_near(kEnough * static_cast<std::size_t>(std::max(count, kPlacesMin)), candidates);
  std::vector<ProbingPlace> chosen;
  Mat6 unknown = Mat6::Identity();  // covariance left, in units of the tolerance
  while (static_cast<int>(chosen.size()) < count && !candidates.empty()) {
    const auto best =
        std::max_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
          return a.row.dot(unknown * a.row) < b.row.dot(unknown * b.row);
        });
    const Candidate taken = *best;
    chosen.push_back(taken.place);
    const Row known = unknown * taken.row;
    unknown -= known * known.transpose() / (1 + taken.row.dot(known));
    std::erase_if(candidates,
                  [&](const Candidate& c) { return (c.place.p_W - taken.place.p_W).norm() < kApart; });
  }
  if (static_cast<int>(chosen.size()) < kPlacesMin)
    throw InputError(fmt::format(
        "the gap sensor can look at {} places of the part, at least {} are needed to register it{}",
        chosen.size(), kPlacesMin, commonest(refusals)));
  return chosen;
}

// No machine is so large, and squares of much larger distances have no number.
constexpr double kFarthest = 100;  // [m]

std::vector<ProbingPlace> read_pattern(const std::filesystem::path& path, const geometry::Mesh& part,
                                       const ProbingCheck& check) {
  std::istringstream in(read_file(path));
  std::vector<ProbingPlace> places;
  for (const NumberRow& row : read_number_table(in, path.string(), {"x_mm", "y_mm", "z_mm"})) {
    const Place at{path.string(), row.line, 0};
    const Vec3 p = kMillimetre * Vec3(row.values[0], row.values[1], row.values[2]);
    if (p.cwiseAbs().maxCoeff() > kFarthest)
      throw InputError(at, fmt::format("({:g}, {:g}, {:g}) mm is beyond {:g} mm", row.values[0],
                                       row.values[1], row.values[2], to_mm(kFarthest)));
    const geometry::SurfacePoint nearest = part.nearest(p);
    if (!(nearest.distance <= kOffPart))
      throw InputError(at,
                       fmt::format("the point is {:.3f} mm off the drawn part, at most {:g} mm are allowed: "
                                   "the pattern belongs to another part, or to this one elsewhere",
                                   to_mm(nearest.distance), to_mm(kOffPart)));
    const ProbingPlace place{nearest.position, nearest.normal, row.line};
    for (const ProbingPlace& other : places)
      if ((other.p_W - place.p_W).norm() < kOffPart)
        throw InputError(at,
                         fmt::format("the same place as in line {}: nothing new is seen there", other.line));
    if (const std::string why = check.why_not(place); !why.empty())
      throw InputError(at, "this place cannot be measured: " + why);
    places.push_back(place);
  }
  if (static_cast<int>(places.size()) < kPlacesMin)
    throw InputError(
        {path.string(), 0, 0},
        fmt::format("{} places, at least {} are needed: a pose has six freedoms", places.size(), kPlacesMin));
  return places;
}

}  // namespace understudy::control
