#include "sim/surface/bead_sweep.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace understudy::sim {
namespace {

constexpr std::size_t kLookAhead = 128;  // sections that one straight piece may stand for
constexpr double kFrontLag = 0.2e-3;     // [m], by which a piece's front may lead or trail as it grows
constexpr int kSidesMost = 32;
constexpr double kPole = 0.02;  // of a quarter turn: a cap ends in a small ring instead of a point

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

BeadSection between(const BeadSection& a, const BeadSection& b, double share) {
  BeadSection s = b;
  s.middle_W = a.middle_W + share * (b.middle_W - a.middle_W);
  s.up_W = (a.up_W + share * (b.up_W - a.up_W)).normalized();
  s.width = a.width + share * (b.width - a.width);
  s.height = a.height + share * (b.height - a.height);
  s.laid_at = a.laid_at + share * (b.laid_at - a.laid_at);
  return s;
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
    const BeadSection there = between(a, b, share);
    if (difference(s, there) > tolerance) return false;
    if (std::abs(s.laid_at - there.laid_at) * speed > std::max(kFrontLag, tolerance)) return false;
  }
  return true;
}

BeadStretch simplified(const BeadStretch& sections, const SweepSettings& settings) {
  BeadStretch kept{sections.front()};
  for (std::size_t at = 0; at + 1 < sections.size();) {
    std::size_t next = at + 1;
    const std::size_t most = std::min(sections.size() - 1, at + kLookAhead);
    const auto within = [&](std::size_t i) {
      return (sections[i].middle_W - sections[at].middle_W).norm() <= settings.longest;
    };
    while (next < most && within(next + 1) && stands_for(sections, at, next + 1, settings.tolerance)) ++next;
    kept.push_back(sections[next]);
    at = next;
  }
  return kept;
}

/// Gathers beads while each goes on where the one before ended.
class Sweeper {
 public:
  explicit Sweeper(const SweepSettings& settings) : settings_(settings), tolerance_(settings.tolerance) {}

  void take(const Bead& bead) {
    if (is_blob(bead)) {
      close();
      stretches_.push_back({end_of(bead)});
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
      open_.back() = between(joint, start, 0.5);
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
    if (!open_.empty()) stretches_.push_back(simplified(open_, settings_));
    open_.clear();
  }

  std::vector<BeadStretch> finish() {
    close();
    return std::move(stretches_);
  }

 private:
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
  std::vector<BeadStretch> stretches_;
  BeadStretch open_;
  Vec3 along_{0, 0, 0}, end_W_{HUGE_VAL, 0, 0};
  double last_at_ = 0, speed_ = 0;  // of the last bead
  double not_before_ = 0;           // of the open stretch
};

struct Frame {
  Vec3 along, side, up;
};

Frame frame_at(const BeadStretch& stretch, std::size_t i) {
  const Vec3 before = i > 0 ? Vec3(stretch[i].middle_W - stretch[i - 1].middle_W) : Vec3::Zero();
  const Vec3 after =
      i + 1 < stretch.size() ? Vec3(stretch[i + 1].middle_W - stretch[i].middle_W) : Vec3::Zero();
  Frame frame;
  frame.along = (before.stableNormalized() + after.stableNormalized()).stableNormalized();
  const Vec3 side = frame.along.cross(stretch[i].up_W);
  // Laid straight along the tool axis, the section has no height direction of its own.
  frame.side = side.norm() > 1e-6 ? side.normalized() : frame.along.unitOrthogonal();
  frame.up = frame.side.cross(frame.along);
  return frame;
}

/// A ring: two half circles about the ends of the flat core, counter-clockwise seen along `along`.
void append_ring(const BeadSection& section, const Frame& frame, double latitude, int sides,
                 std::vector<Vec3>& vertices) {
  const double radius = 0.5 * section.height, flat = 0.5 * (section.width - section.height);
  const Vec3 centre = section.middle_W + radius * std::sin(latitude) * frame.along;
  for (const int half : {1, -1})
    for (int k = 0; k <= sides / 2; ++k) {
      const double angle = half * std::numbers::pi * (static_cast<double>(k) / (sides / 2) - 0.5);
      const double out = radius * std::cos(latitude);
      vertices.push_back(centre + half * (flat + out * std::cos(angle)) * frame.side +
                         half * (half * out * std::sin(angle)) * frame.up);
    }
}

/// A blob, or one bead from end to end: append_shell() closes its ends without a ring.
bool is_one_bead(const BeadStretch& stretch) {
  return stretch.size() == 1 ||
         (stretch.size() == 2 && stretch[0].width == stretch[1].width &&
          stretch[0].height == stretch[1].height && stretch[0].up_W == stretch[1].up_W);
}

Bead bead_of(const BeadStretch& stretch) {
  const BeadSection &from = stretch.front(), &to = stretch.back();
  Bead bead;
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    bead.from_W[n] = static_cast<float>(from.middle_W[i]);
    bead.to_W[n] = static_cast<float>(to.middle_W[i]);
    bead.up_W[n] = static_cast<float>(from.up_W[i]);
  }
  bead.width = static_cast<float>(from.width);
  bead.height = static_cast<float>(from.height);
  return bead;
}

}  // namespace

std::vector<BeadStretch> sweep_beads(const BeadIndex& beads, const SweepSettings& settings) {
  Sweeper sweeper(settings);
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Bead bead = beads.bead(i);
    if (static_cast<double>(bead.laid_at) > settings.by) break;
    if (settings.chosen && !(*settings.chosen)[i])
      sweeper.close();
    else
      sweeper.take(bead);
  }
  return sweeper.finish();
}

std::size_t section_count(const std::vector<BeadStretch>& stretches) {
  std::size_t count = 0;
  for (const BeadStretch& stretch : stretches) count += stretch.size();
  return count;
}

void append_sweep(const BeadStretch& stretch, int sides, BeadMesh& mesh) {
  if (is_one_bead(stretch)) {
    append_shell(bead_of(stretch), sides, mesh);
    return;
  }
  const ShellSize size = sweep_size(stretch, sides);
  if (mesh.vertices.size() + size.vertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError("a mesh of beads has " + std::to_string(mesh.vertices.size() + size.vertices) +
                     " vertices, more than 2^31 - 1");
  const int first = static_cast<int>(mesh.vertices.size()), around = sides + 2, quarter = sides / 4;
  const auto latitude = [&](int step) {
    return 0.5 * std::numbers::pi * std::min(static_cast<double>(step) / quarter, 1 - kPole);
  };
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const Frame frame = frame_at(stretch, i);
    if (i == 0)
      for (int step = quarter; step > 0; --step)
        append_ring(stretch[i], frame, -latitude(step), sides, mesh.vertices);
    append_ring(stretch[i], frame, 0, sides, mesh.vertices);
    if (i + 1 == stretch.size())
      for (int step = 1; step <= quarter; ++step)
        append_ring(stretch[i], frame, latitude(step), sides, mesh.vertices);
  }
  const int rings = static_cast<int>(stretch.size()) + 2 * quarter;
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const int a = first + ring * around + k, b = first + ring * around + (k + 1) % around;
      mesh.triangles.push_back({a, b + around, b});
      mesh.triangles.push_back({a, a + around, b + around});
    }
  const int last = first + (rings - 1) * around;
  for (int k = 1; k + 1 < around; ++k) {
    mesh.triangles.push_back({first, first + k, first + k + 1});
    mesh.triangles.push_back({last, last + k + 1, last + k});
  }
}

ShellSize sweep_size(const BeadStretch& stretch, int sides) {
  if (is_one_bead(stretch)) return shell_size(bead_of(stretch), sides);
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
