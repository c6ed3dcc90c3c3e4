#include "sim/surface/bead_sweep.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

#include "sim/surface/swept_shell.h"

namespace understudy::sim {
namespace {

constexpr std::size_t kLookAhead = 128;  // sections that one straight piece may stand for
constexpr double kFrontLag = 0.2e-3;     // [m], by which a piece's front may lead or trail as it grows
constexpr int kSidesMost = 32;

Vec3 wide(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

bool is_blob(const Bead& bead) { return bead.from_W == bead.to_W; }

BeadSection start_of(const Bead& bead, double laid_at) {
  return {wide(bead.from_W),
          wide(bead.up_W).normalized(),
          static_cast<double>(bead.width),
          static_cast<double>(bead.height),
          laid_at,
          bead.line};
}

BeadSection end_of(const Bead& bead) {
  BeadSection section = start_of(bead, static_cast<double>(bead.laid_at));
  section.middle_W = wide(bead.to_W);
  return section;
}

/// How far apart the surfaces of two sections are at most.
double difference(const BeadSection& a, const BeadSection& b) {
  const double widths = 0.5 * std::abs(a.width - b.width), heights = 0.5 * std::abs(a.height - b.height);
  return (a.middle_W - b.middle_W).norm() + std::max(widths, heights) +
         0.5 * a.width * (a.up_W - b.up_W).norm();
}

/// By how much a mitre's corner lies outside the round one that two beads make.
double mitre_error(const Vec3& before, const Vec3& after, double width) {
  const double cosine = std::clamp(before.normalized().dot(after.normalized()), -1.0, 1.0);
  const double half = std::sqrt(0.5 * (1 + cosine));  // of the cosine of half the turn
  return half > 0.1 ? 0.5 * width * (1 / half - 1) : std::numeric_limits<double>::infinity();
}

/// Whether the chord from `first` to `last` stands for every section between.
bool stands_for(const BeadStretch& sections, std::size_t first, std::size_t last, double tolerance) {
  const BeadSection &a = sections[first], &b = sections[last];
  const Vec3 chord = b.middle_W - a.middle_W;
  const double length2 = chord.squaredNorm();
  if (!(length2 > 0)) return false;
  const double speed = std::sqrt(length2) / std::max(b.laid_at - a.laid_at, 1e-6);
  double before = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const BeadSection& s = sections[i];
    const double share = (s.middle_W - a.middle_W).dot(chord) / length2;
    if (share < before || share > 1) return false;
    before = share;
    const BeadSection there = section_between(a, b, share);
    if (difference(s, there) > tolerance) return false;
    if (std::abs(s.laid_at - there.laid_at) * speed > std::max(kFrontLag, tolerance)) return false;
  }
  return true;
}

/// The farthest section that a straight piece from `at` reaches. It is looked for in steps that double and
/// then halve: a piece as long as its neighbours takes a few looks at it, not one for each of its sections.
std::size_t reach(const BeadStretch& sections, std::size_t at, const SweepSettings& settings) {
  const std::size_t most = std::min(sections.size() - 1, at + kLookAhead);
  const auto reaches = [&](std::size_t i) {
    return (sections[i].middle_W - sections[at].middle_W).norm() <= settings.longest &&
           stands_for(sections, at, i, settings.tolerance);
  };
  std::size_t good = at + 1, bad = most + 1;
  for (std::size_t step = 1; good < most && bad > most; step *= 2) {
    const std::size_t next = std::min(good + step, most);
    (reaches(next) ? good : bad) = next;
  }
  while (bad - good > 1) {
    const std::size_t middle = good + (bad - good) / 2;
    (reaches(middle) ? good : bad) = middle;
  }
  return good;
}

BeadStretch simplified(const BeadStretch& sections, const SweepSettings& settings) {
  BeadStretch kept{sections.front()};
  for (std::size_t at = 0; at + 1 < sections.size();) {
    at = reach(sections, at, settings);
    kept.push_back(sections[at]);
  }
  return kept;
}

/// Gathers beads while each goes on where the one before ended.
class Sweeper {
 public:
  Sweeper(const SweepSettings& settings, const std::function<bool(BeadStretch)>& take)
      : settings_(settings), tolerance_(settings.tolerance), take_(take) {}

  void take(const Bead& bead) {
    if (is_blob(bead)) {
      close();
      hand_over({end_of(bead)});
      note(bead, static_cast<double>(bead.laid_at));
      return;
    }
    const Vec3 along = wide(bead.to_W) - wide(bead.from_W);
    const BeadSection start = start_of(bead, begun_at(bead));
    // They meet half-way, where each is off by half of what parts them.
    const bool goes_on = !open_.empty() && difference(open_.back(), start) <= 2 * tolerance_ &&
                         mitre_error(along_, along, start.width) <= tolerance_;
    if (goes_on) {
      const BeadSection joint = open_.back();
      open_.back() = section_between(joint, start, 0.5);
      open_.back().laid_at = joint.laid_at;
      open_.back().line = joint.line;
    } else {
      close();
      open_ = {start};
      not_before_ = last_at_;
    }
    open_.push_back(end_of(bead));
    along_ = along;
    note(bead, start.laid_at);
  }

  /// What comes next begins anew.
  void close() {
    if (open_.size() > 2) begin_later();
    if (!open_.empty()) hand_over(simplified(open_, settings_));
    open_.clear();
  }

  bool is_wanted() const { return is_wanted_; }

 private:
  void hand_over(BeadStretch stretch) { is_wanted_ = is_wanted_ && take_(std::move(stretch)); }

  /// A bead states the time of its end only: it was begun when the one before ended, or, behind a travel, as
  /// long before as it takes at the speed of what was laid last.
  double begun_at(const Bead& bead) const {
    const double end = static_cast<double>(bead.laid_at);
    const double length = (wide(bead.to_W) - wide(bead.from_W)).norm();
    if ((wide(bead.from_W) - end_W_).norm() < static_cast<double>(bead.width)) return std::min(last_at_, end);
    return speed_ > 0 ? std::max(std::min(last_at_, end), end - length / speed_) : end;
  }

  void note(const Bead& bead, double begun_at) {
    const double end = static_cast<double>(bead.laid_at);
    const double length = (wide(bead.to_W) - wide(bead.from_W)).norm();
    if (end > begun_at && length > 0) speed_ = length / (end - begun_at);
    last_at_ = end;
    end_W_ = wide(bead.to_W);
  }

  /// The first bead was laid about as fast as the second; what is left of its time was travel.
  void begin_later() {
    const BeadSection &one = open_[1], &two = open_[2];
    const double took = two.laid_at - one.laid_at, length = (two.middle_W - one.middle_W).norm();
    if (length > 0)
      open_[0].laid_at =
          std::max(not_before_, one.laid_at - took * (one.middle_W - open_[0].middle_W).norm() / length);
  }

  SweepSettings settings_;
  double tolerance_;
  const std::function<bool(BeadStretch)>& take_;
  bool is_wanted_ = true;
  BeadStretch open_;
  Vec3 along_{0, 0, 0}, end_W_{HUGE_VAL, 0, 0};
  double last_at_ = 0, speed_ = 0;  // of the last bead
  double not_before_ = 0;           // of the open stretch
};

}  // namespace

BeadSection section_between(const BeadSection& a, const BeadSection& b, double share) {
  BeadSection s = b;
  s.middle_W = a.middle_W + share * (b.middle_W - a.middle_W);
  s.up_W = (a.up_W + share * (b.up_W - a.up_W)).normalized();
  s.width = a.width + share * (b.width - a.width);
  s.height = a.height + share * (b.height - a.height);
  s.laid_at = a.laid_at + share * (b.laid_at - a.laid_at);
  return s;
}

bool sweep_beads(const BeadIndex& beads, const SweepSettings& settings,
                 const std::function<bool(BeadStretch)>& take) {
  Sweeper sweeper(settings, take);
  for (std::size_t i = 0; i < beads.size() && sweeper.is_wanted(); ++i) {
    const Bead bead = beads.bead(i);
    if (static_cast<double>(bead.laid_at) > settings.by) break;
    if (settings.chosen && !(*settings.chosen)[i])
      sweeper.close();
    else
      sweeper.take(bead);
  }
  sweeper.close();
  return sweeper.is_wanted();
}

std::vector<BeadStretch> sweep_beads(const BeadIndex& beads, const SweepSettings& settings) {
  std::vector<BeadStretch> stretches;
  sweep_beads(beads, settings, [&](BeadStretch stretch) {
    stretches.push_back(std::move(stretch));
    return true;
  });
  return stretches;
}

void append_sweep(const BeadStretch& stretch, int sides, BeadMesh& mesh) {
  if (is_one_bead(stretch)) return append_shell(one_bead(stretch), sides, mesh);
  SweptShell shell{std::move(mesh), {}, {}};
  append_swept(stretch, {0, stretch.size() - 1}, sides, shell);
  mesh = std::move(shell.mesh);
}

ShellSize sweep_size(const BeadStretch& stretch, int sides) {
  if (is_one_bead(stretch)) return shell_size(one_bead(stretch), sides);
  const auto around = static_cast<std::size_t>(sides) + 2;
  const std::size_t rings = stretch.size() + 2 * static_cast<std::size_t>(sides / 4);
  return {rings * around, 2 * (rings - 1) * around + 2 * (around - 2)};
}

int sides_within(const BeadStretch& stretch, double error) {
  double height = 0;
  for (const BeadSection& section : stretch) height = std::max(height, section.height);
  int sides = 4;
  while (sides < kSidesMost && 0.5 * height * (1 - std::cos(std::numbers::pi / sides)) > error) sides += 4;
  return sides;
}

}  // namespace understudy::sim
