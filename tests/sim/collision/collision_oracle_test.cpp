// The adaptive observer against a slow, obvious one: the clearance at every thousandth of the way. What it
// takes for contact is asked of FCL as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random_vector.h"
#include "sim/collision/collision.h"
#include "sim/collision/fcl_world.h"
#include "sim/distance/mesh_clearance.h"
#include "sim/distance/penetration.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPolytope = 0.5e-6;  // [m], FCL's round bodies

struct Motion {
  Pose from, to;
  geometry::Shape part;
};

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

// A box, often a thin one, near the nozzle, the block or the platform; the tool passes over or through it.
Motion random_motion(Random& random) {
  Motion m;
  const double slide = random.uniform() < 0.3 ? 30e-3 : 3e-3;
  m.from =
      make_pose(exp_rotation(random_vector(random, 0.3)), Vec3(0, 0, 0.05) + random_vector(random, slide));
  m.to = make_pose(exp_rotation(random_vector(random, 0.3)), Vec3(0, 0, 0.05) + random_vector(random, slide));
  Vec3 size(random.uniform(1e-3, 20e-3), random.uniform(1e-3, 20e-3), random.uniform(1e-3, 20e-3));
  if (random.uniform() < 0.5) size[static_cast<Eigen::Index>(random.bits() % 3)] = 0.03e-3;
  const Vec3 centre = Vec3(0, 0, 0.05 + random.uniform(-10e-3, 25e-3)) + random_vector(random, 12e-3);
  m.part = {"part",
            geometry::MeshShape{test::box_mesh(centre, size, exp_rotation(random_vector(random, 1.5)))},
            Pose::Identity()};
  return m;
}

struct Seen {
  double least = kInfinity;  // [m], of the samples
  double deepest = 0;        // [m], a lower bound
};

Seen sample(const MeshClearance& part, const geometry::Shape& shape, const Motion& m, int samples) {
  const ConvexSolid solid = *convex_solid(shape);
  Seen seen;
  for (int i = 0; i <= samples; ++i) {
    const Pose X = interpolate(m.from, m.to, static_cast<double>(i) / samples) * shape.X_FS;
    const double d = part.distance(solid, X).distance;
    seen.least = std::min(seen.least, d);
    if (d <= 0 && seen.deepest < 0.1e-3) {
      seen.deepest = std::max(seen.deepest, penetration(shape, X, m.part, Pose::Identity()).depth);
    }
  }
  return seen;
}

struct Tally {
  int hits = 0, grazes = 0, clear = 0;
};

void compare(std::uint64_t seed, int samples, Tally& tally) {
  Random random(seed, "collision oracle");
  const Motion m = random_motion(random);
  const auto machine = test::hexapod();
  const CollisionOptions options;
  CollisionObserver observer(machine, test::as_designed(machine),
                             std::get<geometry::MeshShape>(m.part.form).mesh, options);
  Snapshot s;
  s.X_WT = m.from;
  observer.observe(s);
  s.X_WT = m.to;
  s.time = 1;
  observer.observe(s);

  FclWorld world;
  const int part = world.add(m.part);
  const MeshClearance clearance(std::get<geometry::MeshShape>(m.part.form).mesh);
  const double path = (m.to.translation() - m.from.translation()).norm();
  const double turn = angle_between(m.from.linear(), m.to.linear());
  const auto contacts = observer.collisions();
  for (const geometry::Shape& shape : machine.tool.bodies) {
    const int body = world.add(shape);
    const Seen seen = sample(clearance, shape, m, samples);
    const auto hit = std::find_if(contacts.begin(), contacts.end(), [&](const Contact& c) {
      return c.body == shape.name && c.obstacle == "part";
    });
    const bool found = hit != contacts.end();
    // Half a margin is what the motion between two looks may hide.
    if (seen.deepest > options.margin / 2) {
      EXPECT_TRUE(found) << shape.name << " is " << seen.deepest << " m deep, seed " << seed;
    }
    if (found) {
      const Pose X = interpolate(m.from, m.to, hit->time) * shape.X_FS;
      // FCL knows surfaces only: a body that starts inside the part is far from its surface.
      EXPECT_TRUE(world.distance(body, X, part, Pose::Identity()).distance <= kPolytope ||
                  contains(m.part, X * point_of(shape)))
          << "false alarm, seed " << seed;
    }
    (found ? tally.hits : seen.least <= 0 ? tally.grazes : tally.clear) += 1;
    if (found) continue;
    // Between two samples the clearance falls by at most half of what the body moves.
    const double between = (path + 0.05 * turn) / samples / 2;
    const double reported =
        shape.name == "nozzle" ? observer.min_nozzle_clearance() : observer.min_clearance();
    // A motion may end at its least, where nothing comes after that would have been looked at.
    const double accuracy = shape.name == "nozzle" ? options.margin / 4 : 0.05e-3;
    EXPECT_LE(reported, seen.least + std::max(accuracy, 0.01 * seen.least) + kPolytope)
        << shape.name << ", seed " << seed;
    if (shape.name == "nozzle") {
      EXPECT_GE(reported, seen.least - between - kPolytope) << "seed " << seed;
    }
  }
}

TEST(CollisionOracle, RandomMotionsAgreeWithDenseSampling) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) compare(seed, 150, tally);
  EXPECT_GT(tally.hits, 10);
  EXPECT_GT(tally.clear, 15);
}

TEST(SlowCollisionOracle, ThousandsOfRandomMotionsAgreeWithDenseSampling) {
  Tally tally;
  for (std::uint64_t seed = 1001; seed <= 4000; ++seed) compare(seed, 1000, tally);
  RecordProperty("hits", tally.hits);
  RecordProperty("grazes", tally.grazes);
  RecordProperty("clear", tally.clear);
  EXPECT_GT(tally.hits, 1000);
  EXPECT_GT(tally.clear, 1000);
  // What is within half a margin of touching may go either way; it must be rare.
  EXPECT_LT(tally.grazes, tally.hits / 50);
}

}  // namespace
}  // namespace understudy::sim
