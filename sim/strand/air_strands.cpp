#include "sim/strand/air_strands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <numbers>
#include <thread>
#include <utility>

#include "core/units.h"
#include "sim/deposition/bead_temperature.h"
#include "sim/strand/strand.h"
#include "sim/strand/strand_path.h"

namespace understudy::sim {
namespace {

constexpr double kInAir = 2;              // diameters above what is below
constexpr double kStraight = 0.05;        // of the length, beside the chord
constexpr double kShortest = 0.2e-3;      // [m]: less hangs from the bead's own stiffness
constexpr std::size_t kMostPoints = 400;  // of a curved strand: some seconds
constexpr double kMostOverfeed = 0.1;     // more is a heap, not a strand
constexpr double kPointSpacing = 0.5e-3;  // [m], of a curved strand's points

double area_of(const UnsupportedStretch& stretch) { return stretch.volume / stretch.length; }

Surroundings air_around(const UnsupportedStretch& stretch, const machine::MachineDescription& machine) {
  Surroundings air;
  air.temperature = machine.process.ambient_temperature;
  air.air_speed = machine.process.fan_air_speed * stretch.fan;
  return air;
}

double largest_offset(const std::vector<Vec3>& path, const Vec3& from, const Vec3& chord) {
  const Vec3 along = chord.normalized();
  double most = 0;
  for (const Vec3& p : path) {
    const Vec3 reach = p - from;
    most = std::max(most, (reach - reach.dot(along) * along).norm());
  }
  return most;
}

class Solver {
 public:
  Solver(const machine::MachineDescription& machine, const machine::Material& material)
      : machine_(machine), material_(material), free_diameter_(free_strand_diameter(machine)) {}

  AirStrand solve(const UnsupportedStretch& stretch) {
    AirStrand strand;
    strand.line = stretch.line;
    strand.time = stretch.time;
    strand.from_W = stretch.path_W.front();
    strand.to_W = stretch.path_W.back();
    strand.length = stretch.length;
    strand.duration = stretch.laid_at.back() - stretch.laid_at.front();
    strand.speed = stretch.length / std::max(1e-6, strand.duration);
    const double drawn = std::sqrt(4 * area_of(stretch) / std::numbers::pi);
    strand.diameter = std::min(drawn, free_diameter_);
    strand.overfeed = std::max(0.0, drawn * drawn / (free_diameter_ * free_diameter_) - 1);
    strand.small = strand.overfeed <= kMostOverfeed;
    strand.held_at_end = stretch.held_at_end;
    const Vec3 chord = strand.to_W - strand.from_W;
    strand.straight = chord.norm() > 0.5 * stretch.length &&
                      largest_offset(stretch.path_W, strand.from_W, chord) <= kStraight * stretch.length;
    if (strand.straight) {
      solve_straight(stretch, chord, strand);
    } else {
      solve_curved(stretch, strand);
    }
    lay_down(stretch, strand);
    return strand;
  }

 private:
  /// A strand sags no farther than to what lies below it.
  static void lay_down(const UnsupportedStretch& stretch, AirStrand& strand) {
    const double below = std::isfinite(stretch.worst_gap) ? stretch.worst_gap : kGapReach;
    if (strand.sag <= below) return;
    strand.sag_place_W.z() += strand.sag - below;
    strand.sag = below;
    strand.lies = true;
  }

  void solve_straight(const UnsupportedStretch& stretch, const Vec3& chord, AirStrand& strand) {
    AirSpan span;
    span.length = chord.norm();
    span.diameter = strand.diameter;
    span.speed = strand.speed * span.length / stretch.length;
    span.nozzle_temperature = temperature_of(stretch);
    span.slope = std::asin(std::clamp(chord.z() / span.length, -1.0, 1.0));
    span.overfeed = std::min(strand.overfeed, kMostOverfeed);
    span.surroundings = air_around(stretch, machine_);
    span.end = strand.held_at_end ? Hold::clamped : Hold::free;
    const StrandResult& result = cached(span);
    strand.sag = result.sag_max;
    strand.sag_place_W =
        strand.from_W + chord * (result.sag_max_position / span.length) - Vec3(0, 0, result.sag_max);
    strand.solid_after = result.solid_at;
    strand.small = strand.small && result.slope_max < 0.3 && !result.falls;
  }

  /// A program that runs outside the material's range is reported elsewhere; its strands are solved at the
  /// limit.
  double temperature_of(const UnsupportedStretch& stretch) const {
    return in_range(stretch.nozzle_temperature);
  }

  double in_range(double temperature) const {
    if (temperature <= 0) return 0;  // not known: the material's own
    return std::clamp(temperature, material_.nozzle_temperature_min, material_.nozzle_temperature_max);
  }

  const StrandResult& cached(AirSpan& span) {
    const auto rounded = [](double& value, double step) {
      const long n = std::lround(value / step);
      value = static_cast<double>(n) * step;
      return n;
    };
    double log_speed = std::log(span.speed);
    span.length = std::max(span.length, kShortest);
    const std::array key{rounded(span.length, 0.1e-3),
                         rounded(span.diameter, 2e-6),
                         rounded(log_speed, 0.01),
                         rounded(span.nozzle_temperature, 1.0),
                         rounded(span.slope, from_deg(0.5)),
                         rounded(span.overfeed, 1e-3),
                         rounded(span.surroundings.air_speed, 0.01),
                         static_cast<long>(span.end)};
    span.speed = std::exp(log_speed);
    span.nozzle_temperature = in_range(span.nozzle_temperature);  // rounding may have left it
    const auto [entry, is_new] = solved_.try_emplace(key);
    if (is_new) entry->second = compute_sag(material_, span);
    return entry->second;
  }

  void solve_curved(const UnsupportedStretch& stretch, AirStrand& strand) const {
    AirPath path;
    for (std::size_t i = 0; i < stretch.path_W.size(); ++i) {
      const bool last = i + 1 == stretch.path_W.size();
      if (!path.points_W.empty() && !last &&
          (stretch.path_W[i] - path.points_W.back()).norm() < kPointSpacing)
        continue;
      if (!path.laid_at.empty() && stretch.laid_at[i] <= path.laid_at.back()) continue;
      path.points_W.push_back(stretch.path_W[i]);
      path.laid_at.push_back(stretch.laid_at[i]);
    }
    if (path.points_W.size() < 3) return;
    strand.solved = path.points_W.size() <= kMostPoints;
    if (!strand.solved) return;
    path.diameter = strand.diameter;
    path.nozzle_temperature = temperature_of(stretch);
    path.surroundings = air_around(stretch, machine_);
    path.end_supported = strand.held_at_end;
    const PathSag sag = compute_sag(material_, path);
    strand.sag = sag.sag_max;
    strand.sag_place_W = path.points_W[sag.sag_max_point] + sag.displacement_W[sag.sag_max_point];
    strand.solid_after = sag.solid_at - path.laid_at.front();
    strand.small = strand.small && sag.small;
  }

  const machine::MachineDescription& machine_;
  const machine::Material& material_;
  double free_diameter_;
  std::map<std::array<long, 8>, StrandResult> solved_;
};

}  // namespace

bool spans_a_groove(const UnsupportedStretch& stretch) {
  if (stretch.adhesion != Adhesion::unsupported) return false;
  const int held = (stretch.held_at_start ? 1 : 0) + (stretch.held_at_end ? 1 : 0);
  return stretch.length <= held * stretch.width;
}

bool hangs_in_air(const UnsupportedStretch& stretch) {
  if (stretch.adhesion != Adhesion::unsupported || !stretch.held_at_start || spans_a_groove(stretch))
    return false;
  if (stretch.length < kShortest) return false;
  const double diameter = std::sqrt(4 * area_of(stretch) / std::numbers::pi);
  return stretch.worst_gap > kInAir * diameter || (stretch.held_at_end && stretch.on_printed);
}

struct AirStrandSolver::State {
  const machine::MachineDescription& machine;
  const machine::Material& material;
  std::mutex mutex{};
  std::condition_variable changed{};
  std::deque<UnsupportedStretch> waiting{};
  std::map<std::size_t, AirStrand> solved{};
  std::size_t taken = 0;  // the number of the next that waits
  bool no_more = false;
  std::exception_ptr failure{};
  std::thread thread{};  // from the first strand on

  void solve() {
    Solver solver(machine, material);
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [this] { return no_more || !waiting.empty(); });
      if (waiting.empty()) return;
      const UnsupportedStretch stretch = std::move(waiting.front());
      waiting.pop_front();
      const std::size_t number = taken++;
      lock.unlock();
      AirStrand strand;
      std::exception_ptr thrown;
      try {
        strand = solver.solve(stretch);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      solved[number] = strand;
      if (thrown && !failure) failure = thrown;
    }
  }

  void end() {
    {
      const std::lock_guard lock(mutex);
      no_more = true;
    }
    changed.notify_all();
  }
};

AirStrandSolver::AirStrandSolver(const machine::MachineDescription& machine,
                                 const machine::Material& material)
    : state_(new State{machine, material}) {}

AirStrandSolver::~AirStrandSolver() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->waiting.clear();
  }
  state_->end();
  if (state_->thread.joinable()) state_->thread.join();
}

void AirStrandSolver::add(const UnsupportedStretch& stretch) {
  if (!hangs_in_air(stretch)) return;
  {
    const std::lock_guard lock(state_->mutex);
    state_->waiting.push_back(stretch);
  }
  if (!state_->thread.joinable()) state_->thread = std::thread([this] { state_->solve(); });
  state_->changed.notify_one();
}

std::vector<AirStrand> AirStrandSolver::finish() {
  State& state = *state_;
  state.end();
  if (state.thread.joinable()) {
    state.solve();
    state.thread.join();
  }
  if (state.failure) std::rethrow_exception(state.failure);
  std::vector<AirStrand> strands;
  for (const auto& [number, strand] : state.solved) strands.push_back(strand);
  return strands;
}

}  // namespace understudy::sim
