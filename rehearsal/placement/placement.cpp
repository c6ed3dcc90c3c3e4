#include "rehearsal/placement/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "control/motion/constraint_check.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "rehearsal/fixture.h"
#include "rehearsal/placement/checked_path.h"
#include "rehearsal/placement/home_posture.h"
#include "rehearsal/placement/placement_search.h"
#include "rehearsal/placement/placement_task.h"
#include "rehearsal/program/program_reading.h"

namespace understudy::rehearsal {
namespace {

constexpr double kGain = 0.02;  // that a turn must bring: without one, nobody has to think about it
constexpr int kTurns = 12, kTurnGrid = 9;  // tried, 30 degrees apart, each on so many points a side
constexpr int kStarts = 3;
constexpr int kRounds = 5;  // of check and search again with the poses that the check found
constexpr double kSameShare = 1e-4;

using Progress = std::function<void(double, const std::string&)>;

double degrees(double angle) {
  constexpr double kTenths = 10;
  const double turn = std::remainder(std::round(kTenths * to_deg(angle)) / kTenths, 360);
  return turn <= -180 ? turn + 360 : turn + 0.0;
}

/// A machine in one of its postures at home, and the search with it.
struct Attempt {
  Attempt(const machine::MachineDescription& standing, std::vector<double> home,
          const std::shared_ptr<const geometry::Mesh>& obstacle, const ProgramPath& path, const Area& area)
      : machine(standing),
        home_axes(std::move(home)),
        shares(machine, obstacle),
        search(shares, path, area.lower, area.upper) {}

  machine::MachineDescription machine;
  std::vector<double> home_axes;  ///< empty: those of the request
  PoseShares shares;
  PlacementSearch search;
};

class Finder {
 public:
  Finder(const RehearsalRequest& request, const PlacementOptions& options, Progress progress)
      : request_(request),
        options_(options),
        progress_(std::move(progress)),
        task_(read_placement_task(request)),
        now_(attempt({})) {}

  Placement find() {
    const auto [columns, rows] = grid_size(task_.area, options_.grid);
    coarse_ =
        Vec2((task_.area.upper - task_.area.lower).cwiseQuotient(Vec2(columns - 1, rows - 1))).maxCoeff();
    std::vector<Candidate> map = now_->search.grid(
        columns, rows, 0, 0, [&](double share) { tell(0.05 + 0.35 * share, "looking at places"); });
    now_->search.settle_counts();
    Candidate best = best_of(map);
    if (options_.may_turn) best = turned(best);
    if (options_.may_change_posture) best = in_best_posture(best);
    const CheckedPath checked = settle(best);
    if (best.stand.turn != 0 || best.stand.spin != 0 || !now_->home_axes.empty())
      map = now_->search.grid(columns, rows, best.stand.turn, best.stand.spin, {});
    fill_map(map, columns, rows, best.stand);
    fill_answer(best.stand, checked);
    return std::move(answer_);
  }

 private:
  std::unique_ptr<Attempt> attempt(const std::vector<double>& home_axes) const {
    machine::MachineDescription standing = task_.machine;
    stand_at_home(home_axes, standing);
    return std::make_unique<Attempt>(standing, home_axes, task_.obstacle, task_.path, task_.area);
  }

  void tell(double share, const std::string& what) const {
    if (progress_) progress_(share, what);
  }

  Candidate best_of(const std::vector<Candidate>& all) {
    std::vector<Candidate> starts = all;
    std::stable_sort(starts.begin(), starts.end(),
                     [&](const Candidate& a, const Candidate& b) { return now_->search.better(a, b); });
    starts.resize(std::min<std::size_t>(starts.size(), kStarts));
    Candidate best = starts.front();
    for (const Candidate& start : starts)
      if (Candidate found = now_->search.refine(start, coarse_ / 2, 0, 0); now_->search.better(found, best))
        best = std::move(found);
    return best;
  }

  bool gains(const Candidate& a, const Candidate& b) const {
    return now_->search.margin(a.shares) > now_->search.margin(b.shares) + kGain;
  }

  /// The best of turning the program, and after that of turning the tool.
  Candidate turned(Candidate best) {
    constexpr double kStep = 2 * std::numbers::pi / kTurns;
    const auto try_all = [&](bool spin, double from) {
      std::vector<Candidate> all;
      for (int k = 1; k < kTurns; ++k) {
        const double angle = k <= kTurns / 2 ? k * kStep : (k - kTurns) * kStep;
        const Stand& at = best.stand;
        for (Candidate& c :
             now_->search.grid(kTurnGrid, kTurnGrid, spin ? at.turn : angle, spin ? angle : at.spin, {}))
          all.push_back(std::move(c));
        tell(from + 0.15 * k / kTurns, spin ? "turning the tool" : "turning the program");
      }
      const Candidate start = *std::min_element(
          all.begin(), all.end(), [&](const auto& a, const auto& b) { return now_->search.better(a, b); });
      const double step = Vec2((task_.area.upper - task_.area.lower) / (kTurnGrid - 1)).maxCoeff() / 2;
      Candidate found = now_->search.refine(start, step, spin ? 0 : kStep / 2, spin ? kStep / 2 : 0);
      if (gains(found, best)) best = std::move(found);
    };
    if (!task_.path.turns) try_all(false, 0.4);
    if (!task_.path.turns && now_->shares.mechanism().follows_spin()) try_all(true, 0.55);
    best.stand.turn = from_deg(degrees(best.stand.turn));
    best.stand.spin = from_deg(degrees(best.stand.spin));
    return now_->search.refine(best, coarse_ / 4, 0, 0);
  }

  /// An arm that reaches home in several ways may go on in another one.
  Candidate in_best_posture(Candidate best) {
    const auto postures = other_home_postures(task_.machine);
    for (std::size_t k = 0; k < postures.size(); ++k) {
      tell(0.6 + 0.1 * static_cast<double>(k) / static_cast<double>(postures.size()), "other postures");
      auto other = attempt(postures[k]);
      const auto all = other->search.grid(kTurnGrid, kTurnGrid, best.stand.turn, best.stand.spin, {});
      other->search.settle_counts();
      const Candidate start = *std::min_element(
          all.begin(), all.end(), [&](const auto& a, const auto& b) { return other->search.better(a, b); });
      const double step = Vec2((task_.area.upper - task_.area.lower) / (kTurnGrid - 1)).maxCoeff() / 2;
      const Candidate found = other->search.refine(start, step, 0, 0);
      looked_at_ += other->search.looked_at();
      if (other->search.margin(found.shares) <= now_->search.margin(best.shares) + kGain) continue;
      best = found;
      std::swap(now_, other);
    }
    return best;
  }

  /// Checks every pose; where one has less than the samples knew, searches again with that pose.
  CheckedPath settle(Candidate& best) {
    CheckedPath checked;
    for (int round = 0; round < kRounds; ++round) {
      tell(0.7 + 0.05 * round, "checking every pose");
      best.stand = rounded(best.stand);
      checked = check_path(now_->shares, task_.path, best.stand);
      bool learned = false;
      for (std::size_t i = 0; i < checked.shares.size(); ++i)
        if (checked.shares[i] < best.shares[i] - kSameShare) {
          now_->search.add_sample(checked.worst[i].pose);
          learned = true;
        }
      if (!learned || round + 1 == kRounds) break;
      best = now_->search.refine(now_->search.look(best.stand), coarse_ / 4, 0, 0);
      if (now_->search.margin(checked.shares) < 0) best = from_grid_again(best);
    }
    return checked;
  }

  /// With the poses that are known by now another part of the table may be better.
  Candidate from_grid_again(const Candidate& best) {
    std::vector<Candidate> all =
        now_->search.grid(kTurnGrid, kTurnGrid, best.stand.turn, best.stand.spin, {});
    all.push_back(best);
    return best_of(all);
  }

  /// To what `--place` says: a micrometre.
  Stand rounded(const Stand& stand) const {
    const Vec3 origin = task_.path.origin_W(stand);
    const Vec2 told(from_mm(told_mm(origin.x())), from_mm(told_mm(origin.y())));
    Stand there = stand;
    there.middle += told - origin.head<2>();
    return there;
  }

  void fill_map(const std::vector<Candidate>& all, int columns, int rows, const Stand& best) {
    PlacementMap& map = answer_.map;
    map.columns = columns;
    map.rows = rows;
    const Vec2 first = now_->search.grid_point(0, 0, columns, rows),
               next = now_->search.grid_point(1, 1, columns, rows);
    map.x_mm = to_mm(first.x());
    map.y_mm = to_mm(first.y());
    map.x_step_mm = to_mm(next.x() - first.x());
    map.y_step_mm = to_mm(next.y() - first.y());
    for (const Candidate& c : all) map.margin.push_back(now_->search.margin(c.shares));
    map.best_x_mm = to_mm(best.middle.x());
    map.best_y_mm = to_mm(best.middle.y());
  }

  void fill_answer(const Stand& stand, const CheckedPath& checked) {
    const Vec3 origin = task_.path.origin_W(stand);
    answer_.place = {told_mm(origin.x()), told_mm(origin.y()), told_mm(origin.z()),
                     degrees(stand.turn), degrees(stand.spin), now_->home_axes};
    answer_.margin = now_->search.margin(checked.shares);
    const std::size_t least = now_->search.least(checked.shares);
    answer_.least = now_->shares.name(least);
    for (std::size_t i = 1; i < now_->shares.size(); ++i)
      answer_.limits.push_back({now_->shares.name(i), checked.shares[i],
                                std::max(checked.shares[i], now_->search.best_shares()[i]),
                                now_->search.counts(i), checked.worst[i].pose.line});
    answer_.poses = checked.poses;
    answer_.searched_poses = static_cast<int>(now_->search.samples());
    answer_.placements = looked_at_ + now_->search.looked_at();
    look_at_given();
    constexpr double kRounding = 1e-9;  // a print that just fits, fits
    answer_.possible = answer_.margin >= -kRounding;
    if (!answer_.possible) {
      const CheckedPath::Worst& worst = checked.worst[least];
      answer_.reason = fmt::format(
          "{} (line {})", now_->shares.broken(least, task_.path.placed(worst.pose, stand), worst.axes),
          worst.pose.line);
      return;
    }
    require_followable();
  }

  /// The check of a rehearsal: the ways from and to home, and between the branches of an arm.
  void require_followable() {
    tell(0.95, "checking limits");
    const auto program = read_program(placed(request_, answer_.place), now_->machine).program;
    for (const auto& finding : control::check_constraints(program, now_->machine).findings) {
      if (finding.violation.kind == kinematics::LimitKind::axis_velocity) continue;
      answer_.possible = false;
      answer_.reason = fmt::format("{} (line {})", to_string(finding.violation), finding.line);
      return;
    }
  }

  /// [0, 1], at the request's own place, if that is as high.
  void look_at_given() {
    const DialectRequest& dialect = request_.dialect;
    if (dialect.place_auto || from_mm(dialect.place_mm[2]) != task_.path.height) return;
    Stand given{{0, 0}, from_deg(dialect.turn_deg), from_deg(dialect.spin_deg)};
    given.middle = Vec2(from_mm(dialect.place_mm[0]), from_mm(dialect.place_mm[1])) +
                   Eigen::Rotation2Dd(given.turn) * task_.path.middle();
    answer_.margin_as_given = now_->search.margin(check_path(now_->shares, task_.path, given).shares);
  }

  RehearsalRequest request_;
  PlacementOptions options_;
  Progress progress_;
  PlacementTask task_;
  std::unique_ptr<Attempt> now_;
  double coarse_ = 0;  // [m], between points of the grid
  int looked_at_ = 0;  // with other postures
  Placement answer_;
};

}  // namespace

Placement find_placement(const RehearsalRequest& request, const PlacementOptions& options,
                         const std::function<void(double, const std::string&)>& progress) {
  return Finder(request, options, progress).find();
}

}  // namespace understudy::rehearsal
