// Chains as they are built: errors as large as the tolerances say, axes that stay axes.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {
namespace {

constexpr int kMachines = 600;

/// Sum of squares over draws with the tolerance that belongs to them.
struct Spread {
  double squares = 0;
  int draws = 0;
  void add(double value) {
    squares += value * value;
    ++draws;
  }
  /// The standard error of a standard deviation over n draws is sigma / sqrt(2 n); four of them.
  void expect(double sigma, const char* what) const {
    if (draws == 0) return;
    EXPECT_NEAR(std::sqrt(squares / draws), sigma, 4 * sigma / std::sqrt(2.0 * draws)) << what;
  }
};

class SampledChain : public testing::TestWithParam<const char*> {
 protected:
  const machine::MachineDescription machine_ = machine::load_machine(GetParam());
  const kinematics::Chain& nominal_ = machine_.chain().kinematics.chain;
};

TEST_P(SampledChain, ErrorsSpreadAsTheToleranceSetStates) {
  for (const auto& [set, tolerance] : {std::pair{"sampled", machine_.tolerances.after_calibration},
                                       std::pair{"manufactured", machine_.tolerances.manufactured}}) {
    Spread position, tilt, length, angle, tip, rod;
    for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
      const AsBuilt built = make_as_built(machine_, set, seed);
      for (std::size_t i = 0; i < nominal_.axes.size(); ++i) {
        const kinematics::ChainAxis &is = built.chain.axes[i], &should = nominal_.axes[i];
        // Two directions across the axis, each with its own tilt; tilts are below 3 mrad, sines are angles.
        const Vec3 x = should.direction.unitOrthogonal(), y = should.direction.cross(x);
        tilt.add(is.direction.dot(x));
        tilt.add(is.direction.dot(y));
        for (int k = 0; k < 3; ++k) position.add(is.point[k] - should.point[k]);
        (should.angle ? angle : length).add(built.axis_zero[i]);
      }
      for (std::size_t i = 0; i < nominal_.rods.size(); ++i) rod.add(built.chain.rods[i] - nominal_.rods[i]);
      for (int k = 0; k < 3; ++k)
        tip.add((built.chain.X_OT_zero.translation() - nominal_.X_OT_zero.translation())[k]);
    }
    position.expect(tolerance.axis_position, "point of an axis");
    tilt.expect(tolerance.axis_direction, "direction of an axis");
    length.expect(tolerance.zero_length, "zero of a slide");
    angle.expect(tolerance.zero_angle, "zero of a turn");
    tip.expect(tolerance.axis_position, "the tool's mount");
    rod.expect(tolerance.rod_length, "length of a rod");
  }
}

TEST_P(SampledChain, AxesStayUnitVectorsAndTheToolsMountARotation) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const AsBuilt built = make_as_built(machine_, "manufactured", seed);
    for (const auto& axis : built.chain.axes) EXPECT_NEAR(axis.direction.norm(), 1, 1e-15);
    const Mat3 R = built.chain.X_OT_zero.linear();
    EXPECT_NEAR((R * R.transpose() - Mat3::Identity()).norm(), 0, 1e-14);
    EXPECT_EQ(built.chain.tool_axis, nominal_.tool_axis);
    EXPECT_EQ(built.chain.work_axis, nominal_.work_axis);
  }
}

TEST_P(SampledChain, ASeedIsAMachine) {
  const auto first = make_as_built(machine_, "sampled", 7), again = make_as_built(machine_, "sampled", 7),
             other = make_as_built(machine_, "sampled", 8), made = make_as_built(machine_, "manufactured", 7);
  for (std::size_t i = 0; i < nominal_.axes.size(); ++i) {
    EXPECT_EQ(first.chain.axes[i].point, again.chain.axes[i].point);
    EXPECT_EQ(first.chain.axes[i].direction, again.chain.axes[i].direction);
    EXPECT_EQ(first.axis_zero[i], again.axis_zero[i]);
    EXPECT_NE(first.chain.axes[i].point, other.chain.axes[i].point);
    EXPECT_NE(first.chain.axes[i].direction, other.chain.axes[i].direction);
    EXPECT_NE(first.chain.axes[i].point, made.chain.axes[i].point);
  }
  EXPECT_NE(first.chain.X_OT_zero.translation(), other.chain.X_OT_zero.translation());
}

TEST_P(SampledChain, NominalIsTheDescription) {
  const AsBuilt built = make_as_built(machine_, "nominal", 3);
  for (std::size_t i = 0; i < nominal_.axes.size(); ++i) {
    EXPECT_EQ(built.chain.axes[i].point, nominal_.axes[i].point);
    EXPECT_EQ(built.chain.axes[i].direction, nominal_.axes[i].direction);
    EXPECT_EQ(built.axis_zero[i], 0);
    EXPECT_EQ(built.axis_play[i], machine_.chain().play[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, SampledChain, testing::Values("arm", "five-axis", "finishing", "delta"),
                         [](const auto& one) {
                           std::string name = one.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace understudy::sim
