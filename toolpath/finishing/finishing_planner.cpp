#include "toolpath/finishing/finishing_planner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/finishing/outline_places.h"
#include "toolpath/finishing/standing_height.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kBeside = 6e-3;  // [m]: this near, and turned so little, the tool goes straight
constexpr double kBesideTurn = 20 * kDegree;
constexpr double kTravelTurn = 10 * kDegree;  // of one move over the part
constexpr int kMostLayers = 10'000;

/// Where the tool stands to cut.
struct Stand {
  Vec3 p, n;
  double lift = 0;
  bool cuts = true;
};

void check(const geometry::Mesh& part, const FinishingPlan& plan) {
  check_positive("depth of cut", to_mm(plan.depth), "mm");
  if (plan.depth > 2 * plan.mill_radius)
    throw InputError(fmt::format("depth of cut is {:g} mm, more than the end mill's diameter of {:g} mm",
                                 to_mm(plan.depth), to_mm(2 * plan.mill_radius)));
  check_positive("pitch", to_mm(plan.pitch), "mm");
  if (plan.pitch >= 2 * plan.mill_radius)
    throw InputError(
        fmt::format("pitch is {:g} mm, not less than the end mill's diameter of {:g} mm: it "
                    "would leave ribs",
                    to_mm(plan.pitch), to_mm(2 * plan.mill_radius)));
  check_positive("step", to_mm(plan.step), "mm");
  check_positive("reach of the fit", to_mm(plan.fit_reach), "mm");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  if (part.open_edges() > 0)
    throw InputError(fmt::format("{} open edges: the part must be closed", part.open_edges()));
  if (plan.from > plan.to)
    throw InputError(fmt::format("the lowest layer at {:g} mm is above the highest at {:g} mm",
                                 to_mm(plan.from), to_mm(plan.to)));
  if ((plan.to - plan.from) / plan.pitch > kMostLayers)
    throw InputError(fmt::format("more than {} layers: choose a coarser pitch", kMostLayers));
}

class Planner {
 public:
  Planner(const geometry::Mesh& part, const geometry::Mesh& stock, const geometry::Mesh& table,
          const FinishingPlan& plan)
      : mesh_(part), part_(part), stock_(stock), table_(table), plan_(plan), top_(stock.upper().z()) {}

  FinishingProgram run() {
    const int gaps = static_cast<int>(std::ceil((plan_.to - plan_.from) / plan_.pitch - 1e-9));
    for (int layer = gaps; layer >= 0; --layer) {
      const double share = gaps > 0 ? static_cast<double>(layer) / gaps : 0;
      const double height = plan_.from + share * (plan_.to - plan_.from);
      bool any = false;
      for (const Outline& outline : outlines_at(mesh_, height, plan_.step, plan_.fit_reach)) {
        result_.fit_deviation = std::max(result_.fit_deviation, outline.deviation);
        any = add_outline(outline) || any;
      }
      result_.layers += any;
      tell(plan_.progress, static_cast<std::size_t>(gaps - layer + 1), static_cast<std::size_t>(gaps + 1),
           "layers");
    }
    if (result_.outlines == 0)
      throw InputError(fmt::format(
          "nothing to cut: between z = {:g} and {:g} mm the part has no outline that the end mill "
          "of {:g} mm can stand on",
          to_mm(plan_.from), to_mm(plan_.to), to_mm(2 * plan_.mill_radius)));
    rise();
    result_.program = builder_.take();
    return std::move(result_);
  }

 private:
  Stand stand_at(const OutlinePlace& place) const {
    Stand stand{place.position, place.normal};
    stand.lift = part_.of(place.position, place.normal, plan_.mill_radius, 0);
    if (stand.lift < kTouching) stand.lift = 0;
    stand.cuts = stand.lift < plan_.depth;
    if (stand.cuts) check_clear(stand);
    return stand;
  }

  void check_clear(const Stand& stand) const {
    const auto refuse = [&](const std::string& what, const char* obstacle, double depth, const char* then) {
      throw InputError(fmt::format("at {} the {} would reach {:.2f} mm into the {}: {}", in_mm(stand.p), what,
                                   to_mm(depth), obstacle, then));
    };
    constexpr const char* kHigher = "begin with a higher layer (--from), or raise the part";
    const double under = table_.of(stand.p, stand.n, plan_.mill_radius, stand.lift) - stand.lift;
    if (under > 0) refuse("end mill", "table", under, kHigher);
    for (const ToolRing& ring : plan_.rings) {
      const double from = ring.from + stand.lift;
      if (const double deep = table_.of(stand.p, stand.n, ring.radius, from) - from; deep > 0)
        refuse(ring.name, "table", deep, kHigher);
      if (const double deep = stock_.of(stand.p, stand.n, ring.radius, from) - from; deep > kTouching)
        refuse(ring.name, "part", deep, "it needs a longer end mill or a slimmer tool");
    }
  }

  bool add_outline(const Outline& outline) {
    std::vector<Stand> stands;
    for (const OutlinePlace& place : outline.places) stands.push_back(stand_at(place));
    for (const Stand& stand : stands) {
      result_.left_out += !stand.cuts;
      if (stand.cuts) result_.lift_max = std::max(result_.lift_max, stand.lift);
    }
    const std::size_t n = stands.size();
    std::size_t begin = 0;
    const Vec3 wanted = builder_.empty() ? plan_.first_axis : Vec3(builder_.tool().linear().col(2));
    const Vec3 near = builder_.empty() ? Vec3(1e3 * wanted) : Vec3(builder_.tool().translation());
    for (std::size_t i = 1; i < n; ++i)
      if (rank(stands[i], wanted, near) < rank(stands[begin], wanted, near)) begin = i;
    std::rotate(stands.begin(), stands.begin() + static_cast<std::ptrdiff_t>(begin), stands.end());
    if (!stands.front().cuts) return false;
    stands.push_back(stands.front());
    for (std::size_t i = 0; i < stands.size();) {
      const std::size_t from = i;
      while (i < stands.size() && stands[i].cuts) ++i;
      if (i > from) add_run(stands, from, i);
      while (i < stands.size() && !stands[i].cuts) ++i;
    }
    ++result_.outlines;
    return true;
  }

  /// Places where the tool cuts, then near ones whose normal is the tool's axis.
  double rank(const Stand& stand, const Vec3& axis, const Vec3& near) const {
    return (stand.cuts ? 0 : 1e6) + (1 - stand.n.dot(axis)) + 1e-3 * (stand.p - near).norm();
  }

  void add_run(const std::vector<Stand>& stands, std::size_t from, std::size_t to) {
    approach(stands[from]);
    for (std::size_t i = from; i < to; ++i) {
      builder_.move(pose(stands[i], stands[i].lift), i == from ? plan_.approach_feed : plan_.feed);
      if (i > from) result_.length += (stands[i].p - stands[i - 1].p).norm();
    }
    builder_.travel(pose(stands[to - 1], plan_.depth + plan_.clearance));
  }

  static Pose pose(const Stand& stand, double height) { return tool_at(stand.p, stand.n, height); }

  void approach(const Stand& stand) {
    const Pose X = pose(stand, plan_.depth + plan_.clearance);
    if (builder_.empty()) {
      builder_.travel(raised(X));
    } else {
      const Vec3 a = builder_.tool().linear().col(2);
      const bool beside = (builder_.tool().translation() - X.translation()).norm() < kBeside &&
                          a.dot(stand.n) > std::cos(kBesideTurn);
      if (!beside) go_over(X, stand.n);
    }
    builder_.travel(X);
  }

  void rise() { builder_.travel(raised(builder_.tool())); }

  /// The same pose with every part of the tool above the stock.
  Pose raised(const Pose& X) const {
    const Vec3 n = X.linear().col(2);
    const double across = std::sqrt(std::max(0.0, 1 - n.z() * n.z()));
    double lowest = -plan_.mill_radius * across;
    for (const ToolRing& ring : plan_.rings)
      lowest = std::min(lowest, std::min(ring.from * n.z(), ring.to * n.z()) - ring.radius * across);
    Pose up = X;
    up.translation().z() = std::max(X.translation().z(), top_ + plan_.clearance - lowest);
    return up;
  }

  void go_over(const Pose& X, const Vec3& n) {
    rise();
    const Pose begin = builder_.tool(), end = raised(X);
    const Vec3 m = begin.linear().col(2);
    const auto azimuth = [](const Vec3& a, double other) {
      return a.head<2>().norm() < 1e-6 ? other : std::atan2(a.y(), a.x());
    };
    const double a = azimuth(m, azimuth(n, 0)), b = azimuth(n, a);
    const double turn = std::remainder(b - a, 2 * std::numbers::pi);
    const double low = std::asin(std::clamp(m.z(), -1.0, 1.0)),
                 rise = std::asin(std::clamp(n.z(), -1.0, 1.0)) - low;
    const int parts =
        std::max(1, static_cast<int>(std::ceil(std::max(std::abs(turn), std::abs(rise)) / kTravelTurn)));
    for (int k = 1; k <= parts; ++k) {
      const double t = static_cast<double>(k) / parts, up = low + t * rise, round = a + t * turn;
      const Vec3 axis(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up));
      const Vec3 p = (1 - t) * begin.translation() + t * end.translation();
      builder_.travel(raised(tool_at(p, k == parts ? n : axis)));
    }
  }

  static constexpr double kTouching = 1e-9;  // [m], rounding
  const geometry::Mesh& mesh_;
  StandingHeight part_, stock_, table_;
  const FinishingPlan& plan_;
  double top_;
  ProgramBuilder builder_{1.75e-3};  // feeds no filament
  FinishingProgram result_;
};

}  // namespace

FinishingProgram plan_finishing(const geometry::Mesh& part, const geometry::Mesh& stock,
                                const geometry::Mesh& table, const FinishingPlan& plan) {
  check(part, plan);
  return Planner(part, stock, table, plan).run();
}

}  // namespace understudy::toolpath
