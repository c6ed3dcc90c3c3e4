// The bead index from 1e3 to 1e6 beads: bytes and time to insert, time of a nozzle's clearance query; brute
// force where that can be waited for, and one FCL object a bead at 1e5. All in one run.
#include <fmt/format.h>

#include <malloc.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <vector>

#include "bench/beads/fcl_beads.h"
#include "bench/beads/printed_block.h"
#include "bench/guarded.h"
#include "core/random.h"
#include "core/units.h"
#include "machine/description.h"
#include "sim/beads/bead_index.h"
#include "sim/beads/bead_shape.h"

namespace understudy::sim {
namespace {

constexpr double kCutoff = 2e-3;  // [m]
constexpr double kBytesLimit = 64, kQueryLimit = 50e-6, kInsertLimit = 1e-6;
constexpr int kTurns = 5;  // best of them: the rest is what else the computer does

/// Of this thread.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::size_t heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct Times {
  double median = 0, p99 = 0;  // [s]
};

// Each query's best time over the turns.
Times time_queries(const std::vector<Pose>& poses, const std::function<double(const Pose&)>& query) {
  std::vector<double> best(poses.size(), std::numeric_limits<double>::infinity());
  double sum = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double begin = cpu_seconds();
      sum += query(poses[i]);
      best[i] = std::min(best[i], cpu_seconds() - begin);
    }
  }
  if (std::isnan(sum)) std::exit(3);
  std::sort(best.begin(), best.end());
  return {best[best.size() / 2], best[best.size() * 99 / 100]};
}

Pose tool_at(const PrintedBlock& block, const Vec3& tip_S, const Vec3& turn) {
  return block.X_WS * make_pose(exp_rotation(turn), tip_S);
}

Vec3 random_turn(Random& random) { return Vec3(random.uniform(-0.35, 0.35), random.uniform(-0.35, 0.35), 0); }

/// Places all over the top, 0.1 to 2 mm above it, tilted to 20 degrees each way: nothing is in a cache.
std::vector<Pose> over_the_top(const PrintedBlock& block, std::size_t count) {
  Random random(1, "over the top");
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double half = block.side / 2;
    const Vec3 tip(random.uniform(-half, half), random.uniform(-half, half),
                   block.height + kLayerHeight + random.uniform(0.1e-3, 2e-3));
    poses.push_back(tool_at(block, tip, random_turn(random)));
  }
  return poses;
}

/// Low beside a wall, 0.1 to 2 mm between it and the nozzle's flank: the most beads in reach.
std::vector<Pose> beside_a_wall(const PrintedBlock& block, std::size_t count) {
  Random random(1, "beside a wall");
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double half = block.side / 2;
    const Vec3 tip(half + 0.5e-3 + random.uniform(0.1e-3, 2e-3) + 0.25 * std::min(block.height, 12e-3),
                   random.uniform(-half, half), random.uniform(0, block.height / 2));
    poses.push_back(tool_at(block, tip, Vec3(0, 0, 0)));
  }
  return poses;
}

/// Along the lines of the last whole layer at the working gap, a step every 0.05 mm.
std::vector<Pose> along_the_path(const PrintedBlock& block, std::size_t count) {
  std::vector<Pose> poses;
  double x = -block.side / 2, y = -block.side / 4, way = 1;
  for (std::size_t i = 0; i < count; ++i) {
    x += way * 0.05e-3;
    if (std::abs(x) > block.side / 2) {
      way = -way;
      y += kLineWidth;
    }
    poses.push_back(tool_at(block, Vec3(x, y, block.height + kLayerHeight + 0.13e-3), Vec3(0.1, 0, 0)));
  }
  return poses;
}

struct Row {
  std::size_t beads = 0;
  double bytes = 0, heap = 0, insert = 0;
  Times top, wall, path;
  double brute = 0;
};

Row measure(const PrintedBlock& block, const ConvexSolid& nozzle, bool with_brute_force) {
  Row row;
  row.beads = block.beads.size();
  const auto n = static_cast<double>(row.beads);
  row.insert = std::numeric_limits<double>::infinity();
  std::unique_ptr<BeadIndex> index;
  for (int turn = 0; turn < 3; ++turn) {
    index.reset();
    const std::size_t heap = heap_bytes();
    const double begin = cpu_seconds();
    index = std::make_unique<BeadIndex>();
    for (const Bead& bead : block.beads) index->add(bead);
    row.insert = std::min(row.insert, (cpu_seconds() - begin) / n);
    row.heap = static_cast<double>(heap_bytes() - heap) / n;
  }
  row.bytes = static_cast<double>(index->bytes()) / n;
  const auto query = [&](const Pose& X) {
    const auto near = index->nearest(nozzle, X, kCutoff);
    return near ? near->separation.distance : kCutoff;
  };
  row.top = time_queries(over_the_top(block, 2000), query);
  row.wall = time_queries(beside_a_wall(block, 2000), query);
  row.path = time_queries(along_the_path(block, 4000), query);
  if (with_brute_force) {
    row.brute = time_queries(over_the_top(block, 5), [&](const Pose& X) {
                  double least = kCutoff;
                  for (const Bead& bead : block.beads) {
                    const double d =
                        separation(std::get<FrustumCore>(nozzle.core), nozzle.radius, X, core_of(bead), least)
                            .distance;
                    least = std::min(least, d);
                  }
                  if (std::abs(least - query(X)) > 2e-9) std::exit(3);
                  return least;
                }).median;
  }
  return row;
}

void print_head() {
  fmt::print("{:>8} {:>13} {:>10} {:>17} {:>17} {:>17} {:>12} {:>8}\n", "beads", "bytes/bead", "insert",
             "over the top", "beside a wall", "along the path", "brute force", "faster");
  fmt::print("{:>8} {:>13} {:>10} {:>17} {:>17} {:>17} {:>12} {:>8}\n", "", "(of the heap)", "us",
             "us median (p99)", "us median (p99)", "us median (p99)", "us median", "");
}

void print_row(const Row& row) {
  const auto times = [](const Times& t) {
    return fmt::format("{:.1f} ({:.1f})", 1e6 * t.median, 1e6 * t.p99);
  };
  fmt::print("{:>8} {:>13} {:>10.3f} {:>17} {:>17} {:>17} {:>12} {:>8}\n", row.beads,
             fmt::format("{:.1f} ({:.1f})", row.bytes, row.heap), 1e6 * row.insert, times(row.top),
             times(row.wall), times(row.path), row.brute > 0 ? fmt::format("{:.0f}", 1e6 * row.brute) : "-",
             row.brute > 0 ? fmt::format("{:.0f} x", row.brute / row.top.median) : "-");
}

void print_peer(const PrintedBlock& block, const geometry::Frustum& nozzle, const Row& ours) {
  const std::size_t heap = heap_bytes();
  const FclBeads peer(block.beads);
  const double bytes = static_cast<double>(heap_bytes() - heap) / static_cast<double>(block.beads.size());
  const Times top =
      time_queries(over_the_top(block, 20), [&](const Pose& X) { return peer.distance(nozzle, X, kCutoff); });
  fmt::print(
      "one FCL object a bead, {} beads: {:.0f} bytes a bead ({:.1f} x ours), query over the top {:.2f} ms "
      "median, {:.2f} ms p99 ({:.0f} x ours)\n",
      block.beads.size(), bytes, bytes / ours.bytes, 1e3 * top.median, 1e3 * top.p99,
      top.median / ours.top.median);
}

int run() {
  const auto machine = machine::load_machine("hexapod");
  const auto& body = machine.tool.bodies.front();
  const auto& frustum = std::get<geometry::Frustum>(body.form);
  const ConvexSolid nozzle = *convex_solid(body);
  fmt::print("{} of the shipped hexapod against a solid block, cut-off {:.0f} mm, best of {} turns\n",
             body.name, to_mm(kCutoff), kTurns);
  print_head();
  std::vector<Row> rows;
  for (const std::size_t beads : {1000, 10000, 100000, 1000000}) {
    const PrintedBlock block = printed_block(beads, 0, 1);
    rows.push_back(measure(block, nozzle, beads <= 100000));
    print_row(rows.back());
  }
  const Row tilted = measure(printed_block(1000000, from_deg(30), 1), nozzle, false);
  print_row(tilted);
  fmt::print("(the last with layers tilted by 30 degrees)\ngrowth a decade, over the top:");
  for (std::size_t i = 1; i < rows.size(); ++i)
    fmt::print(" {:.2f}", rows[i].top.median / rows[i - 1].top.median);
  fmt::print(", beside a wall:");
  for (std::size_t i = 1; i < rows.size(); ++i)
    fmt::print(" {:.2f}", rows[i].wall.median / rows[i - 1].wall.median);
  fmt::print("; linear would be 10\n");
  print_peer(printed_block(100000, 0, 1), frustum, rows[2]);

  bool met = true;
  for (const Row& row : {rows.back(), tilted}) {
    met = met && std::max(row.bytes, row.heap) <= kBytesLimit && row.insert <= kInsertLimit;
    for (const Times& t : {row.top, row.wall, row.path}) met = met && t.median <= kQueryLimit;
  }
  fmt::print("limits at 1e6: {:.0f} bytes a bead, {:.0f} us a query, {:.0f} us an insert: {}\n", kBytesLimit,
             1e6 * kQueryLimit, 1e6 * kInsertLimit, met ? "met" : "MISSED");
  return met ? 0 : 1;
}

}  // namespace
}  // namespace understudy::sim

int main() { return understudy::bench::guarded("bead_index_bench", understudy::sim::run); }
