// The hexapod's inverse kinematics of many poses: nanoseconds a pose by layout, number of rows and threads,
// beside what the memory gives. Layouts: `poses`, 4 x 4 matrices (128 bytes) as inverse_batch() takes them;
// `rows`, seven numbers (56 bytes) as axes_of_poses() takes them.
//
//   pose_array_bench [ROWS ...] [--repeat N]     prints CSV: layout,rows,threads,ns,gb_per_s
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/random_vector.h"
#include "kinematics/hexapod/hexapod_batch.h"
#include "machine/default_machine.h"
#include "machine/pose_array.h"

namespace understudy {
namespace {

using machine::kPoseNumbers;

/// [s], the shortest of several: what the machine can do where nothing else runs.
double shortest(int repeat, const std::function<void()>& work) {
  double best = 1e9;
  for (int n = 0; n < repeat; ++n) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// Of `bytes` a row that are read, or written; what is written is read first.
void print(const char* layout, std::size_t rows, int threads, double seconds, double bytes) {
  const auto count = static_cast<double>(rows);
  std::printf("%s,%zu,%d,%.3f,%.3f\n", layout, rows, threads, 1e9 * seconds / count,
              1e-9 * bytes * count / seconds);
  std::fflush(stdout);
}

void measure(const machine::MachineDescription& machine, std::size_t rows, int repeat) {
  Random random(1, "pose array bench");
  std::vector<double> numbers(kPoseNumbers * rows);
  std::vector<Pose> poses(rows);
  for (std::size_t n = 0; n < rows; ++n) {
    const Pose X =
        machine.X_BT_home * make_pose(exp_rotation(uniform_vec3(random, 0.1)), uniform_vec3(random, 0.02));
    poses[n] = X;
    kinematics::write_pose(machine.X_WB * X, &numbers[kPoseNumbers * n]);
  }
  std::vector<double> axes(6 * rows);
  std::vector<kinematics::StrutLengths> lengths(rows);
  std::vector<kinematics::SolveStatus> statuses(rows);
  std::vector<std::uint8_t> bytes(rows);
  for (const int threads : {1, 2}) {
    print("poses", rows, threads,
          shortest(repeat,
                   [&] {
                     kinematics::inverse_batch(machine.hexapod().geometry, poses, lengths, statuses, threads);
                   }),
          128 + 2 * 48 + 2 * 4);
    print("rows", rows, threads,
          shortest(repeat, [&] { machine::axes_of_poses(machine, numbers, axes, bytes, threads); }),
          56 + 2 * 48 + 2);
    // What a copy of the same rows takes: the memory's own limit.
    std::vector<double> copy(numbers.size());
    print("copy", rows, threads,
          shortest(repeat,
                   [&] {
                     std::vector<std::jthread> others;
                     const auto part = [&](int t) {
                       const auto from = static_cast<std::ptrdiff_t>(numbers.size()) * t / threads;
                       const auto to = static_cast<std::ptrdiff_t>(numbers.size()) * (t + 1) / threads;
                       std::copy(numbers.begin() + from, numbers.begin() + to, copy.begin() + from);
                     };
                     for (int t = 1; t < threads; ++t) others.emplace_back(part, t);
                     part(0);
                   }),
          3 * 56);
  }
}

}  // namespace
}  // namespace understudy

int main(int argc, char** argv) {
  std::vector<std::size_t> rows;
  int repeat = 9;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--repeat" && i + 1 < argc)
      repeat = std::max(1, std::atoi(argv[++i]));
    else if (const long count = std::atol(argv[i]); count > 0)
      rows.push_back(static_cast<std::size_t>(count));
  }
  if (rows.empty()) rows = {1000, 10000, 100000, 1000000};
  const auto machine = understudy::machine::load_machine(understudy::machine::kDefaultMachine);
  std::printf("layout,rows,threads,ns,gb_per_s\n");
  for (const std::size_t count : rows) understudy::measure(machine, count, repeat);
}
