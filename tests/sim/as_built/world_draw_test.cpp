// Built machines differ from their description as the tolerances say, each truth by a stream of its own.
#include "sim/as_built/world_draw.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "machine/optics_mounting.h"
#include "sim/as_built/as_built_file.h"

namespace understudy::sim {
namespace {

using machine::BuiltTolerances;

constexpr int kMachines = 2000;
constexpr double kSigma = 1e-3;  // of whatever unit: small, so that shares and rotations are linear

AsBuilt described() {
  static const machine::MachineDescription hexapod = machine::load_machine("hexapod");
  return as_described(hexapod);
}

AsBuilt drawn(const BuiltTolerances& tolerances, std::uint64_t seed) {
  AsBuilt built = described();
  built.source = "manufactured";
  built.seed = seed;
  draw_world(tolerances, seed, built);
  return built;
}

/// A truth, the tolerance that is said to spread it, and how many numbers it is.
struct Truth {
  std::string name;
  double BuiltTolerances::*tolerance;
  std::function<std::vector<double>(const AsBuilt&)> errors;
  bool amplitude = false;  ///< never below 0: half of a normal distribution
};

std::vector<double> numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::vector<Truth> truths() {
  using T = BuiltTolerances;
  static const AsBuilt is = described();
  const auto share = [](double value, double was) { return std::vector<double>{value / was - 1}; };
  return {
      {"lead", &T::lead, [](const AsBuilt& b) { return std::vector<double>{b.drives[2].scale}; }},
      {"periodic error", &T::periodic,
       [](const AsBuilt& b) { return std::vector<double>{b.drives[2].periodic}; }, true},
      {"part ripple", &T::part_ripple, [](const AsBuilt& b) { return std::vector<double>{b.part.ripple}; },
       true},
      {"play", &T::play, [=](const AsBuilt& b) { return share(b.nut_play[4], is.nut_play[4]); }},
      {"camera centre", &T::camera_centre,
       [=](const AsBuilt& b) {
         const Vec2 by = b.microscope.camera.centre_px - is.microscope.camera.centre_px;
         return std::vector<double>{by.x(), by.y()};
       }},
      {"distortion", &T::distortion,
       [](const AsBuilt& b) { return std::vector<double>{b.microscope.camera.k1}; }},
      {"laser power", &T::laser_power,
       [=](const AsBuilt& b) { return share(b.laser.peak_level, is.laser.peak_level); }},
      {"waist", &T::waist,
       [=](const AsBuilt& b) { return share(b.laser.waist_diameter, is.laser.waist_diameter); }},
      {"blur", &T::blur,
       [=](const AsBuilt& b) { return share(b.microscope.blur_px, is.microscope.blur_px); }},
      {"ambient light", &T::ambient_light,
       [=](const AsBuilt& b) { return share(b.microscope.ambient_level, is.microscope.ambient_level); }},
      {"part position", &T::part_position,
       [](const AsBuilt& b) { return numbers(b.part.X_WF.translation()); }},
      {"part rotation", &T::part_rotation,
       [](const AsBuilt& b) { return numbers(log_rotation(b.part.X_WF.linear())); }},
      {"part size", &T::part_size, [](const AsBuilt& b) { return std::vector<double>{b.part.size - 1}; }},
      {"filament diameter", &T::filament_diameter,
       [=](const AsBuilt& b) { return std::vector<double>{b.filament_diameter - is.filament_diameter}; }},
      {"extruder lag", &T::extruder_lag,
       [=](const AsBuilt& b) { return share(b.extruder_lag, is.extruder_lag); }},
      {"table height", &T::table_height,
       [](const AsBuilt& b) { return std::vector<double>{b.table.height}; }},
      {"table tilt", &T::table_tilt,
       [](const AsBuilt& b) {
         return std::vector<double>{b.table.slope.x(), b.table.slope.y()};
       }},
      {"table flatness", &T::table_flatness,
       [](const AsBuilt& b) { return std::vector<double>{b.table.bow}; }},
      {"nozzle temperature", &T::nozzle_temperature,
       [](const AsBuilt& b) { return std::vector<double>{b.nozzle_offset}; }},
  };
}

TEST(WorldDraw, EachTruthSpreadsAsItsToleranceStates) {
  for (const Truth& truth : truths()) {
    SCOPED_TRACE(truth.name);
    BuiltTolerances tolerances;
    tolerances.*truth.tolerance = kSigma;
    std::vector<double> sums(truth.errors(described()).size()), squares(sums.size());
    for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
      const auto errors = truth.errors(drawn(tolerances, seed));
      for (std::size_t k = 0; k < errors.size(); ++k)
        sums[k] += errors[k], squares[k] += errors[k] * errors[k];
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      // Four standard errors of a mean and of a variance over n draws.
      const double mean = truth.amplitude ? std::sqrt(2 / std::numbers::pi) : 0;
      EXPECT_NEAR(sums[k] / kMachines / kSigma, mean, 4 / std::sqrt(1.0 * kMachines)) << "number " << k;
      EXPECT_NEAR(squares[k] / kMachines / (kSigma * kSigma), 1, 4 * std::sqrt(2.0 / kMachines))
          << "number " << k;
    }
  }
}

TEST(WorldDraw, ATruthMoreChangesNoDrawOfAnother) {
  BuiltTolerances all;
  for (const Truth& truth : truths()) all.*truth.tolerance = kSigma;
  const AsBuilt complete = drawn(all, 5);
  for (const Truth& left_out : truths()) {
    BuiltTolerances without = all;
    without.*left_out.tolerance = 0;
    const AsBuilt built = drawn(without, 5);
    for (const Truth& truth : truths()) {
      if (truth.tolerance == left_out.tolerance)
        EXPECT_NE(truth.errors(built), truth.errors(complete)) << truth.name;
      else
        EXPECT_EQ(truth.errors(built), truth.errors(complete)) << truth.name << " without " << left_out.name;
    }
  }
}

TEST(WorldDraw, NoTruthsShareAStream) {
  BuiltTolerances all;
  for (const Truth& truth : truths()) all.*truth.tolerance = kSigma;
  const AsBuilt built = drawn(all, 9);
  std::vector<double> errors;
  for (const Truth& truth : truths())
    for (const double error : truth.errors(built)) errors.push_back(error);
  std::sort(errors.begin(), errors.end());
  // Differences of shares are rounded; equal draws differ by less than this, others hardly ever.
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_GT(errors[k] - errors[k - 1], 1e-12) << errors[k];
}

/// Errors of the mounting, in units of their tolerances.
std::vector<double> mounting_errors(const AsBuilt& built, const machine::MountingTolerances& t) {
  const AsBuilt is = described();
  const Pose laser = is.laser.X_TL.inverse() * built.laser.X_TL,
             camera = is.microscope.X_TC.inverse() * built.microscope.X_TC;
  const Vec3 laser_turn = log_rotation(laser.linear()) / t.angle,
             camera_turn = log_rotation(camera.linear()) / t.angle,
             offset = camera.translation() / t.position;
  return {laser.translation().x() / t.position,
          laser.translation().y() / t.position,
          laser_turn.x(),
          laser_turn.y(),
          offset.x(),
          offset.y(),
          offset.z(),
          camera_turn.x(),
          camera_turn.y(),
          camera_turn.z(),
          (built.microscope.camera.focal_px / is.microscope.camera.focal_px - 1) / t.scale};
}

TEST(MountingDraw, SpreadsAsItsTolerancesState) {
  const machine::MountingTolerances t{kSigma, kSigma, kSigma};
  std::vector<double> squares(machine::kMountingFreedoms);
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    AsBuilt built = described();
    built.source = "manufactured";
    built.seed = seed;
    draw_mounting(t, seed, built);
    const auto errors = mounting_errors(built, t);
    for (std::size_t k = 0; k < errors.size(); ++k) squares[k] += errors[k] * errors[k];
  }
  for (std::size_t k = 0; k < squares.size(); ++k)
    EXPECT_NEAR(squares[k] / kMachines, 1, 4 * std::sqrt(2.0 / kMachines)) << "freedom " << k;
}

TEST(MountingDraw, StaysWhereItIsWhenTheControllerIsCalibrated) {
  const auto hexapod = machine::load_machine("hexapod");
  machine::MachineDescription calibrated = hexapod;
  calibrated.gap_sensor = {machine::mounting_of(hexapod),
                           "",
                           "",
                           1,
                           machine::MountingMatrix::Zero(),
                           machine::MeasuredWaist{hexapod.laser.waist_diameter, 1e-6}};
  calibrated.laser.X_TL.translation().x() += 0.2e-3;
  calibrated.laser.waist_diameter *= 0.9;
  for (const char* set : {"nominal", "manufactured"}) {
    const machine::Laser of_calibrated = make_as_built(calibrated, set, 4).laser,
                         of_drawn = make_as_built(hexapod, set, 4).laser;
    EXPECT_EQ(of_calibrated.X_TL.matrix(), of_drawn.X_TL.matrix()) << set;
    EXPECT_EQ(of_calibrated.waist_diameter, of_drawn.waist_diameter) << set;
  }
}

TEST(WorldDraw, WithoutTolerancesItIsAsDescribed) {
  AsBuilt built = drawn({}, 3);
  EXPECT_EQ(built.laser.X_TL.matrix(), described().laser.X_TL.matrix());
  EXPECT_EQ(built.part.ripple, 0);
  EXPECT_EQ(built.drives[0].periodic, 0);
}

TEST(WorldDraw, OnlyMachinesAsManufacturedAreDrawn) {
  const auto hexapod = machine::load_machine("hexapod");
  const Pose& laser = described().laser.X_TL;
  EXPECT_EQ(make_as_built(hexapod, "sampled", 3).laser.X_TL.matrix(), laser.matrix());
  EXPECT_EQ(make_as_built(hexapod, "nominal", 3).laser.X_TL.matrix(), laser.matrix());
  EXPECT_NE(make_as_built(hexapod, "manufactured", 3).laser.X_TL.matrix(), laser.matrix());
}

}  // namespace
}  // namespace understudy::sim
