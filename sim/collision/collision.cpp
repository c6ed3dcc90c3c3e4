#include "sim/collision/collision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "geometry/printed_clearance.h"
#include "sim/collision/body_set.h"
#include "sim/collision/conservative_advancement.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastAccuracy = 0.05e-3;  // [m], of min_clearance()
constexpr double kNozzleFineness = 4;  // the nozzle works a few margins from the part: looked at more often
constexpr double kBeadReach = 5e-3;    // [m]: beads farther away from a body than this are not minded
// Looks at beads as near as the nozzle's own layer that ask for contacts alone: what is under the nozzle is
// then passed over, and its distance is not measured.
constexpr int kContactLooks = 10;

Configuration configuration_between(const Snapshot& from, const Snapshot& to, double t) {
  Configuration configuration{interpolate(from.X_WT, to.X_WT, t), from.axes_reached};
  for (std::size_t i = 0; i < configuration.axes.size(); ++i)
    configuration.axes[i] += t * (to.axes_reached[i] - from.axes_reached[i]);
  return configuration;
}

BodySet::Travel travel_between(const Snapshot& from, const Snapshot& to) {
  BodySet::Travel travel;
  travel.path = (to.X_WT.translation() - from.X_WT.translation()).norm();
  travel.turn = angle_between(from.X_WT.linear(), to.X_WT.linear());
  for (std::size_t i = 0; i < travel.axes.size(); ++i)
    travel.axes[i] = std::abs(to.axes_reached[i] - from.axes_reached[i]);
  return travel;
}

}  // namespace

struct CollisionObserver::State {
  struct Look {
    double clearance = kInfinity;  // [m], at the last look
    double budget = 0;             // [m], motion left until the next
    std::size_t beads = 0;         // that it counted with, of a printed pair
    std::size_t nearest_bead = BeadIndex::kAll;
    int for_contacts = 0;  // looks to come that ask for contacts alone
  };

  BodySet bodies;
  CollisionOptions options;
  std::vector<Look> looks;  // one a pair
  std::optional<Snapshot> last;
  std::uint64_t checks = 0;
  Contact closest, closest_nozzle;
  double nozzle_seen = kInfinity;  // [m], least since the snapshot before
  // By line and pair: the deepest.
  std::map<std::pair<int, std::size_t>, Contact> touching, near;

  double contact_level(const BodyPair& pair) const {
    if (pair.printed) return geometry::contact_with_printed(pair.nozzle_at_work, options.bead_press);
    return pair.nozzle_at_work ? options.nozzle_contact : 0.0;
  }
  double near_level(const BodyPair& pair) const {
    if (pair.printed && pair.nozzle_at_work) return contact_level(pair);
    return pair.nozzle_at_work ? options.nozzle_contact : options.near;
  }

  void look(std::size_t index, const Configuration& configuration, double time, int line) {
    const BodyPair& pair = bodies.pairs()[index];
    if (pair.printed) return look_at_beads(index, configuration, time, line);
    Look& at = looks[index];
    // Motion is continuous: a body that was outside gets inside only through a contact that is seen.
    const bool check_inside = !last || at.clearance <= 0;
    const Separation seen = bodies.separation(pair, configuration, check_inside);
    ++checks;
    at.clearance = seen.distance;
    if (pair.nozzle_gap) nozzle_seen = std::min(nozzle_seen, seen.distance);
    record(index,
           {bodies.name(pair.body), bodies.name(pair.obstacle), seen.distance, seen.place_W, time, line});
    at.budget = allowed_motion(seen.distance, limits(index, line));
  }

  void look_at_beads(std::size_t index, const Configuration& configuration, double time, int line) {
    const BodyPair& pair = bodies.pairs()[index];
    Look& at = looks[index];
    const double reach = bead_reach(index, line);
    ++checks;
    const auto found = bodies.nearest_bead(pair, configuration, reach, beads_for(pair), at.nearest_bead);
    at.clearance = kInfinity;
    if (found) {
      at.nearest_bead = found->bead;
      at.clearance = found->separation.distance;
    }
    if (at.clearance <= near_level(pair) || at.clearance < std::min(closest.clearance, kBeadReach)) {
      const int laid_on = options.beads->bead(found->bead).line;
      record(index, {bodies.name(pair.body), "bead of line " + std::to_string(laid_on), at.clearance,
                     found->separation.place_W, time, line, laid_on});
    }
    at.budget = allowed_motion(std::min(at.clearance, reach), limits(index, line));
    if (at.for_contacts > 0)
      --at.for_contacts;
    else if (pair.nozzle_at_work && at.clearance < options.bead_press)
      at.for_contacts = kContactLooks;
  }

  // [m]: how far beads are looked for, so far beyond the clearance that would be recorded that the next look
  // is some motion away.
  double bead_reach(std::size_t index, int line) const {
    if (looks[index].for_contacts > 0) return contact_level(bodies.pairs()[index]);
    return std::max(kBeadReach, limits(index, line).least + kBeadReach / 2);
  }

  // How many beads are there for this pair.
  std::size_t beads_for(const BodyPair& pair) const {
    return pair.nozzle_at_work && options.fresh_from ? std::min(options.fresh_from(), options.beads->size())
                                                     : options.beads->size();
  }

  // Material has appeared since the last snapshot: nearer than what the pair's budget counts with, perhaps.
  void mind_new_beads(std::size_t index, const Configuration& configuration) {
    const BodyPair& pair = bodies.pairs()[index];
    Look& at = looks[index];
    const std::size_t count = beads_for(pair);
    for (std::size_t k = at.beads; k < count && at.budget > 0; ++k) {
      const double clearance = bodies.bead_clearance(pair, configuration, options.beads->bead(k));
      at.budget = std::min(at.budget, std::max(0.0, clearance - near_level(pair)));
    }
    at.beads = count;
  }

  void record(std::size_t index, const Contact& contact) {
    const BodyPair& pair = bodies.pairs()[index];
    const bool over_beads = pair.printed && pair.nozzle_at_work;
    // Level with its own layer the nozzle has no clearance to speak of.
    if (!over_beads || contact.clearance <= contact_level(pair)) {
      Contact& least = over_beads || pair.nozzle_gap ? closest_nozzle : closest;
      if (contact.clearance < least.clearance) least = contact;
    }
    if (contact.clearance > near_level(pair)) return;
    auto& records = contact.clearance <= contact_level(pair) ? touching : near;
    const auto [entry, added] = records.try_emplace({contact.line, index}, contact);
    if (!added && contact.clearance < entry->second.clearance) entry->second = contact;
  }

  ClearanceLimits limits(std::size_t index, int line) const {
    const BodyPair& pair = bodies.pairs()[index];
    ClearanceLimits level;
    level.contact = contact_level(pair);
    level.near = near_level(pair);
    for (const auto* records : {&touching, &near}) {
      const auto entry = records->find({line, index});
      if (entry != records->end()) level.deepest = std::min(level.deepest, entry->second.clearance);
    }
    level.least = pair.nozzle_gap ? closest_nozzle.clearance : closest.clearance;
    level.resolution = pair.nozzle_gap ? options.margin / kNozzleFineness : options.margin;
    level.depth_accuracy = options.margin;
    level.accuracy = pair.nozzle_gap ? level.resolution / 2 : kLeastAccuracy;
    if (pair.printed) level.least = std::min(level.least, kBeadReach);
    if (pair.printed && pair.nozzle_at_work) {
      level.least = -kInfinity;
      level.resolution = level.depth_accuracy = options.bead_press;
    }
    return level;
  }

  // Looks wherever on the path from the last snapshot the pair's budget is used up.
  void advance(std::size_t index, const Snapshot& to, const BodySet::Travel& travel) {
    const BodyPair& pair = bodies.pairs()[index];
    Look& at = looks[index];
    if (pair.printed) mind_new_beads(index, {last->X_WT, last->axes_reached});
    if (to.line != last->line && at.clearance <= near_level(pair)) at.budget = 0;  // each line has its record
    const double motion = bodies.motion(pair, travel);
    double left = motion;
    while (at.budget < left) {
      left -= at.budget;
      const double t = 1 - left / motion;
      look(index, configuration_between(*last, to, t), last->time + t * (to.time - last->time), to.line);
    }
    at.budget -= left;
  }
};

CollisionObserver::CollisionObserver(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                     std::shared_ptr<const geometry::Mesh> part,
                                     const CollisionOptions& options)
    : state_(new State{BodySet(machine, as_built, std::move(part), options.beads, options.cutter),
                       options,
                       {},
                       {},
                       0,
                       {},
                       {},
                       kInfinity,
                       {},
                       {}}) {
  if (!(options.margin > 0))
    throw InputError("collision margin is " + std::to_string(options.margin) + " m, must be above 0");
  state_->looks.resize(state_->bodies.pairs().size());
  state_->closest.clearance = state_->closest_nozzle.clearance = kInfinity;
}

CollisionObserver::~CollisionObserver() = default;

void CollisionObserver::observe(const Snapshot& snapshot) {
  State& s = *state_;
  if (!snapshot.X_WT.matrix().allFinite()) {
    throw MachineError("tool pose is not finite at " + std::to_string(snapshot.time) + " s");
  }
  const std::size_t pairs = s.looks.size();
  s.nozzle_seen = kInfinity;
  if (!s.last) {
    for (std::size_t i = 0; i < pairs; ++i)
      s.look(i, {snapshot.X_WT, snapshot.axes_reached}, snapshot.time, snapshot.line);
  } else {
    const BodySet::Travel travel = travel_between(*s.last, snapshot);
    for (std::size_t i = 0; i < pairs; ++i) s.advance(i, snapshot, travel);
  }
  s.last = snapshot;
}

namespace {

std::vector<Contact> by_time(std::vector<Contact> contacts) {
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Contact& a, const Contact& b) { return a.time < b.time; });
  return contacts;
}

}  // namespace

std::vector<Contact> CollisionObserver::collisions() const {
  std::vector<Contact> contacts;
  for (const auto& [key, contact] : state_->touching) contacts.push_back(contact);
  return by_time(std::move(contacts));
}

std::vector<Contact> CollisionObserver::near_collisions() const {
  std::vector<Contact> contacts;
  for (const auto& [key, contact] : state_->near) {
    if (!state_->touching.contains(key)) contacts.push_back(contact);
  }
  return by_time(std::move(contacts));
}

double CollisionObserver::min_clearance() const { return state_->closest.clearance; }
Contact CollisionObserver::closest() const { return state_->closest; }
double CollisionObserver::min_nozzle_clearance() const { return state_->closest_nozzle.clearance; }
double CollisionObserver::nozzle_clearance_seen() const { return state_->nozzle_seen; }
std::uint64_t CollisionObserver::checks() const { return state_->checks; }
int CollisionObserver::pairs() const { return static_cast<int>(state_->looks.size()); }

}  // namespace understudy::sim
