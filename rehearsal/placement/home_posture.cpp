#include "rehearsal/placement/home_posture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

constexpr int kStarts = 120;    // of the inverse, all over the ranges
constexpr double kSame = 1e-3;  // [rad] or [m]: nearer is the same posture
constexpr double kNear = 1e-6;  // of the pose that a posture must make [m], and of its rotation

double file_unit(bool angle) { return angle ? kDegree : kMillimetre; }

using Axes = std::vector<double>;

bool same(const Axes& a, const Axes& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)) > kSame) return false;
  return true;
}

}  // namespace

void stand_at_home(const std::vector<double>& home, machine::MachineDescription& machine) {
  if (home.empty()) return;
  if (!machine.is_chain())
    throw InputError("--home-axes: a hexapod has one posture for each pose; leave the option out");
  kinematics::ChainDescription& chain = machine.chain().kinematics;
  if (home.size() != chain.chain.axes.size())
    throw InputError(fmt::format("--home-axes: {} numbers for the {} axes of {}", home.size(),
                                 chain.chain.axes.size(), machine.name));
  for (std::size_t i = 0; i < home.size(); ++i) {
    const kinematics::ChainAxis& axis = chain.chain.axes[i];
    const double unit = file_unit(axis.angle), q = unit * home[i];
    if (!(q >= axis.lower && q <= axis.upper))
      throw InputError(fmt::format("--home-axes: {} is {:g} {}, not within {:g}..{:g}", axis.name, home[i],
                                   axis.angle ? "deg" : "mm", axis.lower / unit, axis.upper / unit));
    chain.home[i] = q;
  }
  for (kinematics::AxisWord& word : chain.turn_words) word.home = word.reading(chain.home);
  machine.X_BT_home = kinematics::forward(chain.chain, chain.home);
}

std::vector<std::vector<double>> other_home_postures(const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  if (!machine.is_chain() || !mechanism->follows_spin()) return {};
  const kinematics::ChainDescription& chain = machine.chain().kinematics;
  const auto& axes = chain.chain.axes;
  std::vector<Axes> found{Axes(chain.home.begin(), chain.home.begin() + axes.size())};
  Random random(1, "home postures");
  for (int n = 0; n < kStarts; ++n) {
    Axes start(axes.size()), end(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i)
      start[i] = random.uniform(std::max(axes[i].lower, -std::numbers::pi),
                                std::min(axes[i].upper, std::numbers::pi));
    if (mechanism->inverse(machine.X_BT_home, start, end) != kinematics::SolveStatus::ok) continue;
    bool within = true;
    for (std::size_t i = 0; i < axes.size(); ++i)
      within = within && end[i] >= axes[i].lower && end[i] <= axes[i].upper;
    const Pose off = machine.X_BT_home.inverse() * kinematics::forward(chain.chain, end);
    within = within && off.isApprox(Pose::Identity(), kNear);
    if (within && std::ranges::none_of(found, [&](const Axes& known) { return same(known, end); }))
      found.push_back(end);
  }
  std::vector<Axes> told(found.begin() + 1, found.end());
  for (Axes& posture : told)
    for (std::size_t i = 0; i < posture.size(); ++i) posture[i] /= file_unit(axes[i].angle);
  return told;
}

}  // namespace understudy::rehearsal
