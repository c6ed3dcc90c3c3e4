#include "kinematics/workspace/workspace.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "core/interrupt.h"

namespace understudy::kinematics {
namespace {

constexpr std::int64_t kChunk = 1024;  // points: a few milliseconds, so that threads end together

bool same(const WorkspaceLimit& limit, LimitKind kind, const std::string& part, bool above) {
  return limit.kind == kind && limit.above == above && limit.part == part;
}

int find_or_add(std::vector<WorkspaceLimit>& limits, const LimitViolation& v, const std::string& part) {
  const bool above = v.value > v.limit;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (same(limits[i], v.kind, part, above)) return static_cast<int>(i);
  WorkspaceLimit limit;
  limit.kind = v.kind;
  limit.part = part;
  limit.above = above;
  limit.limit = v.limit;
  limit.unit = v.unit;
  limits.push_back(limit);
  return static_cast<int>(limits.size()) - 1;
}

void add_once(std::vector<int>& set, int value) {
  if (std::find(set.begin(), set.end(), value) == set.end()) set.push_back(value);
}

/// One thread's share of the grid; its counts and the limits that it met, numbered in its own order.
class Evaluation {
 public:
  Evaluation(const Mechanism& mechanism, const WorkspaceRequest& request, Workspace& result)
      : mechanism_(mechanism),
        request_(request),
        result_(result),
        cells_(request.grid.cells()),
        axes_(mechanism.axis_count()) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    use_.assign(axes_.size(), {kFar, -kFar});
    for (int i = 0; i < mechanism.axis_count(); ++i) ranges_.push_back(mechanism.axis_range(i));
  }

  void points(std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) point(i);
  }

  std::vector<WorkspaceLimit> limits, families;
  std::int64_t reachable = 0;
  const std::vector<AxisUse>& use() const { return use_; }

 private:
  void point(std::int64_t i) {
    const auto x = static_cast<int>(i % cells_[0]), y = static_cast<int>(i / cells_[0] % cells_[1]),
               z = static_cast<int>(i / cells_[0] / cells_[1]);
    const Vec3 p_WT = request_.grid.point(x, y, z);
    broken_.clear();
    broken_families_.clear();
    worst_excess_ = -1;
    margin_ = 1;
    condition_ = 0;
    point_use_ = use_;
    for (const Mat3& R_WT : request_.orientations) pose(request_.X_BW * make_pose(R_WT, p_WT));
    if (broken_.empty()) {
      ++reachable;
      use_.swap(point_use_);
      result_.margin[i] = static_cast<float>(margin_);
      result_.condition[i] = static_cast<float>(condition_);
      return;
    }
    result_.binding[i] = static_cast<std::uint16_t>(binding_ + 1);
    count();
  }

  void pose(const Pose& X_BT) {
    const SolveStatus status = mechanism_.inverse(X_BT, {}, axes_);
    violations_.clear();
    mechanism_.check(X_BT,
                     status == SolveStatus::ok ? std::span<const double>(axes_) : std::span<const double>(),
                     violations_);
    if (status != SolveStatus::ok && violations_.empty())
      violations_.push_back(
          {LimitKind::unreachable, std::string("tool pose (") + to_string(status) + ")", 0, 0, ""});
    for (const LimitViolation& violation : violations_) meet(violation);
    if (!broken_.empty()) return;
    use_axes();
    condition_ = std::max(condition_, mechanism_.condition_number(X_BT, axes_));
  }

  void meet(const LimitViolation& violation) {
    const int limit = find_or_add(limits, violation, violation.part);
    WorkspaceLimit& known = limits[limit];
    if (known.broken == 0) known.family = find_or_add(families, violation, limit_family(violation.part));
    add_once(broken_, limit);
    add_once(broken_families_, known.family);
    const double excess = excess_of(violation, families[known.family].part);
    if (excess <= worst_excess_) return;
    worst_excess_ = excess;
    binding_ = limit;
  }

  double excess_of(const LimitViolation& violation, const std::string& family) const {
    if (violation.kind == LimitKind::unreachable) return std::numeric_limits<double>::infinity();
    const double excess = std::abs(violation.value - violation.limit);
    for (const LimitSpan& span : request_.spans)
      if (span.family == family && span.width > 0 && std::isfinite(span.width)) return excess / span.width;
    return excess / std::max(std::abs(violation.value), std::abs(violation.limit));
  }

  void use_axes() {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      point_use_[i].lowest = std::min(point_use_[i].lowest, axes_[i]);
      point_use_[i].highest = std::max(point_use_[i].highest, axes_[i]);
      const auto [lower, upper] = ranges_[i];
      if (std::isfinite(lower) && std::isfinite(upper) && upper > lower)
        margin_ = std::min(margin_,
                           std::max(0.0, 2 * std::min(axes_[i] - lower, upper - axes_[i]) / (upper - lower)));
    }
  }

  void count() {
    for (const int limit : broken_) ++limits[limit].broken;
    for (const int family : broken_families_) ++families[family].broken;
    WorkspaceLimit& first = limits[binding_];
    ++first.binds;
    ++families[first.family].binds;
    if (broken_.size() == 1) ++first.alone;
    if (broken_families_.size() == 1) ++families[first.family].alone;
  }

  const Mechanism& mechanism_;
  const WorkspaceRequest& request_;
  Workspace& result_;
  std::array<int, 3> cells_;
  std::vector<AxisRange> ranges_;
  std::vector<AxisUse> use_, point_use_;
  std::vector<double> axes_;
  std::vector<LimitViolation> violations_;
  std::vector<int> broken_, broken_families_;
  int binding_ = 0;
  double worst_excess_ = -1, margin_ = 1, condition_ = 0;
};

void add_counts(std::vector<WorkspaceLimit>& all, const WorkspaceLimit& more) {
  for (WorkspaceLimit& limit : all) {
    if (!same(limit, more.kind, more.part, more.above)) continue;
    limit.broken += more.broken;
    limit.binds += more.binds;
    limit.alone += more.alone;
    return;
  }
  all.push_back(more);
}

void sort_limits(std::vector<WorkspaceLimit>& limits) {
  std::sort(limits.begin(), limits.end(), [](const WorkspaceLimit& a, const WorkspaceLimit& b) {
    return std::tie(b.binds, b.broken, a.kind, a.part, a.above) <
           std::tie(a.binds, a.broken, b.kind, b.part, b.above);
  });
}

int position(const std::vector<WorkspaceLimit>& limits, const WorkspaceLimit& wanted,
             const std::string& part) {
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (same(limits[i], wanted.kind, part, wanted.above)) return static_cast<int>(i);
  return -1;
}

void merge(const std::vector<Evaluation>& parts, Workspace& result) {
  for (const Evaluation& part : parts) {
    result.reachable += part.reachable;
    for (const WorkspaceLimit& limit : part.limits) add_counts(result.limits, limit);
    for (const WorkspaceLimit& family : part.families) add_counts(result.families, family);
  }
  sort_limits(result.limits);
  sort_limits(result.families);
  for (WorkspaceLimit& limit : result.limits)
    limit.family = position(result.families, limit, limit_family(limit.part));
  for (std::size_t i = 0; i < result.families.size(); ++i) result.families[i].family = static_cast<int>(i);
  if (result.reachable == 0) return;
  result.axes = parts.front().use();
  for (const Evaluation& part : parts) {
    for (std::size_t i = 0; i < result.axes.size(); ++i) {
      result.axes[i].lowest = std::min(result.axes[i].lowest, part.use()[i].lowest);
      result.axes[i].highest = std::max(result.axes[i].highest, part.use()[i].highest);
    }
  }
}

/// Each chunk was numbered by the thread that met it.
void renumber(const std::vector<Evaluation>& parts, const std::vector<int>& worker_of_chunk,
              Workspace& result) {
  std::vector<std::vector<std::uint16_t>> number(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const WorkspaceLimit& limit : parts[p].limits)
      number[p].push_back(static_cast<std::uint16_t>(1 + position(result.limits, limit, limit.part)));
  for (std::size_t i = 0; i < result.binding.size(); ++i) {
    std::uint16_t& binding = result.binding[i];
    if (binding > 0) binding = number[worker_of_chunk[i / kChunk]][binding - 1];
  }
}

}  // namespace

std::array<int, 3> WorkspaceGrid::cells() const {
  std::array<int, 3> count{};
  for (int i = 0; i < 3; ++i)  // the box may miss a whole number of steps by rounding
    count[i] = std::max(1, static_cast<int>(std::floor((upper[i] - lower[i]) / step + 1e-6)));
  return count;
}

std::int64_t WorkspaceGrid::size() const {
  const auto n = cells();
  return std::int64_t{n[0]} * n[1] * n[2];
}

Vec3 WorkspaceGrid::point(int x, int y, int z) const {
  const auto n = cells();
  return 0.5 * (lower + upper) +
         step * Vec3(x - 0.5 * (n[0] - 1), y - 0.5 * (n[1] - 1), z - 0.5 * (n[2] - 1));
}

std::size_t Workspace::index(int x, int y, int z) const {
  const auto n = grid.cells();
  return (std::int64_t{z} * n[1] + y) * n[0] + x;
}

std::string limit_family(const std::string& part) {
  std::string family;
  for (std::size_t begin = 0; begin < part.size();) {
    const std::size_t end = std::min(part.find(' ', begin), part.size());
    const std::string word = part.substr(begin, end - begin);
    const bool number =
        std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!number && word != "and") family += (family.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return family;
}

Workspace evaluate_workspace(const Mechanism& mechanism, const WorkspaceRequest& request) {
  const std::int64_t size = request.grid.step > 0 ? request.grid.size() : 0;
  if (size < 1 || request.orientations.empty() || request.threads < 1)
    throw std::invalid_argument("a workspace needs points, an orientation and a thread");
  Workspace result;
  result.grid = request.grid;
  result.binding.assign(size, 0);
  result.margin.assign(size, 0);
  result.condition.assign(size, 0);
  const std::int64_t chunks = (size + kChunk - 1) / kChunk;
  std::vector<int> worker_of_chunk(chunks, 0);
  const auto threads = static_cast<std::size_t>(std::min<std::int64_t>(request.threads, chunks));
  std::vector<Evaluation> parts(threads, Evaluation(mechanism, request, result));
  std::vector<std::exception_ptr> failures(threads);
  std::atomic<std::int64_t> next{0}, done{0};
  std::mutex progress_mutex;
  const auto work = [&](std::size_t worker) {
    try {
      for (std::int64_t chunk = next++; chunk < chunks; chunk = next++) {
        stop_if_interrupted();
        worker_of_chunk[chunk] = static_cast<int>(worker);
        parts[worker].points(chunk * kChunk, std::min(size, (chunk + 1) * kChunk));
        const std::lock_guard lock(progress_mutex);
        ++done;
        if (request.progress) request.progress(static_cast<double>(done) / static_cast<double>(chunks));
      }
    } catch (...) {
      failures[worker] = std::current_exception();
      next = chunks;
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t i = 1; i < threads; ++i) workers.emplace_back(work, i);
  work(0);
  for (auto& worker : workers) worker.join();
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
  merge(parts, result);
  renumber(parts, worker_of_chunk, result);
  return result;
}

}  // namespace understudy::kinematics
