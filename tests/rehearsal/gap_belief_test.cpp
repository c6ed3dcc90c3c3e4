// What the controller states of the gap: of frames and covariances made by hand, and beside the truth of
// twins.
#include "rehearsal/gap_belief.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "kinematics/hexapod/hexapod.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/run_figures.h"
#include "sim/as_built/as_built_file.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using control::GapControl;
using testing::HasSubstr;

constexpr Eigen::Index kRows = 43;  // of a hexapod's covariance without play

class GapBeliefTest : public testing::Test {
 protected:
  GapBeliefTest() : machine_(machine::load_machine("hexapod")) {}

  std::vector<GapBelief> at(GapControl mode, const std::vector<CommandedInstant>& instants) const {
    return gap_beliefs({machine_, parameters_, mode, result_}, instants);
  }
  std::string stated(GapControl mode) const { return how_stated({machine_, parameters_, mode, result_}); }
  Pose home() const { return machine_.X_WB * machine_.X_BT_home; }
  CommandedInstant extruding(double time) const { return {time, true, home()}; }
  void approach(double time, double gap) {
    control::GapApproach one;
    one.done_at = time;
    one.outcome.gap = gap;
    one.outcome.sigma = 3e-6;
    one.outcome.calibration_sigma = 4e-6;
    result_.approaches.push_back(one);
  }
  void frame(double time, double gap, double sigma) {
    control::GapSample sample;
    sample.time = time;
    sample.believed = gap;
    sample.believed_sigma = sigma;
    if (!result_.following) result_.following.emplace();
    result_.following->samples.push_back(sample);
  }
  /// All six drives zero alike: 1 sigma [m], fully correlated.
  void doubt_zeros(double sigma) {
    parameters_.covariance = Eigen::MatrixXd::Zero(kRows, kRows);
    for (Eigen::Index i = 6; i < 42; i += 7)
      for (Eigen::Index j = 6; j < 42; j += 7) parameters_.covariance(i, j) = sigma * sigma;
  }
  /// By forward kinematics: how far the tip goes along its axis where all struts are longer by `by` [m].
  Vec3 moved_tip(const Pose& X_WT, double by) const {
    const Pose X_BT = machine_.X_WB.inverse() * X_WT;
    const auto& geometry = machine_.hexapod().geometry;
    kinematics::StrutLengths lengths;
    EXPECT_EQ(kinematics::inverse(geometry, X_BT, lengths), kinematics::SolveStatus::ok);
    for (double& length : lengths) length += by;
    const auto reached = kinematics::forward(geometry, lengths, X_BT);
    return reached.X_BT.translation() - X_BT.translation();
  }
  double moved_along_axis(const Pose& X_WT, double by) const {
    return moved_tip(X_WT, by).dot(tool_axis(machine_.X_WB.inverse() * X_WT));
  }
  Pose aside() const {
    return home() * make_pose(Quat(Eigen::AngleAxisd(0.25, Vec3::UnitY())), Vec3(8e-3, 3e-3, 5e-3));
  }

  machine::MachineDescription machine_;
  machine::CalibratedParameters parameters_;
  control::PrintResult result_;
};

TEST_F(GapBeliefTest, WithoutCovarianceAnOpenLoopStatesNone) {
  const auto beliefs = at(GapControl::off, {extruding(1)});
  EXPECT_EQ(beliefs[0].gap, machine_.gap.aim);
  EXPECT_TRUE(std::isnan(beliefs[0].sigma));
  EXPECT_THAT(stated(GapControl::off), HasSubstr("states none"));
}

TEST_F(GapBeliefTest, AnOpenLoopIsAsSureAsItsCalibrationPutsTheTip) {
  doubt_zeros(20e-6);
  for (const Pose& X_WT : {home(), aside()}) {
    const auto beliefs = at(GapControl::off, {{1, true, X_WT}});
    // A step of 20 um is small against struts of 0.2 m: second order is 1e-4 of it.
    EXPECT_NEAR(beliefs[0].sigma, std::abs(moved_along_axis(X_WT, 20e-6)), 0.01e-6);
  }
}

// 3 and 4 um are independent: 5 um.
TEST_F(GapBeliefTest, AfterAnApproachItBelievesWhatItReadThere) {
  approach(1, 0.131e-3);
  approach(3, 0.128e-3);
  const auto beliefs = at(GapControl::start, {extruding(1.5), extruding(2.9), extruding(3.1)});
  EXPECT_EQ(beliefs[0].gap, 0.131e-3);
  EXPECT_EQ(beliefs[2].gap, 0.128e-3);
  for (const GapBelief& belief : beliefs) EXPECT_NEAR(belief.sigma, 5e-6, 1e-12);
  EXPECT_THAT(stated(GapControl::start), HasSubstr("nothing of how the gap changes"));
}

// What is wrong with the geometry at the start has been measured away; along the path its change counts.
TEST_F(GapBeliefTest, AlongTheBeadTheGeometrysChangeSinceTheStartIsAdded) {
  approach(1, 0.131e-3);
  doubt_zeros(20e-6);
  const auto beliefs = at(GapControl::start, {extruding(1), {2, true, aside()}});
  EXPECT_NEAR(beliefs[0].sigma, 5e-6, 1e-12);
  const double change = moved_along_axis(aside(), 20e-6) - moved_along_axis(home(), 20e-6);
  ASSERT_GT(std::abs(change), 0.1e-6);
  EXPECT_NEAR(beliefs[1].sigma, std::hypot(5e-6, change), 0.02e-6);
}

TEST_F(GapBeliefTest, WhereTheGapIsFollowedItIsTheEstimateBetweenFrames) {
  approach(1, 0.131e-3);
  frame(2.0, 0.130e-3, 4e-6);
  frame(2.1, 0.134e-3, 6e-6);
  frame(2.9, 0.120e-3, 4e-6);
  const auto beliefs = at(GapControl::continuous,
                          {extruding(1.5), extruding(2.05), extruding(2.5), extruding(2.95), extruding(3.5)});
  EXPECT_EQ(beliefs[0].gap, 0.131e-3) << "no frame yet";
  EXPECT_NEAR(beliefs[1].gap, 0.132e-3, 1e-12);
  EXPECT_NEAR(beliefs[1].sigma, 5e-6, 1e-12);
  EXPECT_TRUE(std::isnan(beliefs[2].sigma)) << "frames 0.8 s apart";
  EXPECT_NEAR(beliefs[3].sigma, 4e-6, 1e-12);
  EXPECT_TRUE(std::isnan(beliefs[4].sigma)) << "the last frame is old";
}

// The next bead is not what was followed along the one before.
TEST_F(GapBeliefTest, ABeadBeginsWithItsOwnApproach) {
  approach(1, 0.131e-3);
  frame(2.0, 0.130e-3, 4e-6);
  frame(2.02, 0.130e-3, 4e-6);
  approach(2.1, 0.127e-3);
  EXPECT_EQ(at(GapControl::continuous, {extruding(2.15)})[0].gap, 0.127e-3);
}

TEST_F(GapBeliefTest, NothingIsStatedWhereNothingIsExtruded) {
  approach(1, 0.131e-3);
  EXPECT_TRUE(std::isnan(at(GapControl::start, {{1.5, false, home()}})[0].sigma));
}

// Of 10 mm: 6 mm inside, 2 mm outside, 2 mm without a sigma.
TEST(BeliefFigures, AreWeightedByThePath) {
  const auto point = [](double path_mm, double gap_mm) {
    TracePoint p;
    p.extruding = true;
    p.path = path_mm * 1e-3;
    p.gap = gap_mm * 1e-3;
    return p;
  };
  const double none = std::nan("");
  const std::vector<TracePoint> trace{point(0, 0.13), point(6, 0.159), point(8, 0.161), point(10, 0.13)};
  const std::vector<GapBelief> beliefs{{0.13e-3, 10e-6}, {0.13e-3, 10e-6}, {0.13e-3, 10e-6}, {0.13e-3, none}};
  GapFigures gap;
  fill_belief(trace, beliefs, gap);
  EXPECT_NEAR(gap.stated_path_fraction.value(), 0.8, 1e-12);
  EXPECT_NEAR(gap.inside_stated_3_sigma_fraction.value(), 0.75, 1e-12);
  EXPECT_NEAR(gap.stated_sigma_um.value(), 10, 1e-9);
  EXPECT_NEAR(gap.believed_mean_mm.value(), 0.13, 1e-9);
}

/// The bottle's line, its first 2.4 mm.
Record bottle(const std::string& as_built, std::uint64_t seed, const std::string& mode) {
  const TemporaryFolder folder;
  const std::string line =
      read_file(machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode");
  const std::string last = "E0.060344";
  write_file(folder / "line.gcode", line.substr(0, line.find(last)) + last + "\n");
  RehearsalRequest request;
  request.program = (folder / "line.gcode").string();
  request.fixture = "bottle";
  request.engine = "quasistatic";
  request.as_built = as_built;
  request.seed = seed;
  request.gap_control = mode;
  request.keep_scene = request.compare_without_gap_control = false;
  return rehearse(request);
}

/// A machine as drawn whose camera's principal point is not: 64 px/mm (docs/gap-control.md), so 4 px are
/// some 0.06 mm of gap.
std::string with_other_camera() {
  sim::AsBuilt built = sim::make_as_built(machine::load_machine("hexapod"), "nominal", 1);
  built.microscope.camera.centre_px += Vec2(0, 4);
  return sim::write_as_built(built);
}

// The description takes its camera as exact: what it states must neither grow with an error that it cannot
// see nor be 0.
TEST(StatedUncertainty, DoesNotKnowTheTruth) {
  const TemporaryFolder folder;
  const auto file = folder / "other-camera.yaml";
  write_file(file, with_other_camera());
  const Record drawn = bottle("nominal", 3, "start"), other = bottle(file.string(), 3, "start");
  ASSERT_TRUE(drawn.gap && other.gap);
  EXPECT_GT(std::abs(other.gap->start_mm - other.gap->commanded_mm), 0.03);
  EXPECT_LT(other.gap->inside_stated_3_sigma_fraction.value(), 0.05);
  EXPECT_NEAR(other.gap->believed_mean_mm.value(), other.gap->commanded_mm, 0.012) << "as read";
  EXPECT_GT(drawn.gap->stated_sigma_um.value(), 0.5);
  EXPECT_NEAR(other.gap->stated_sigma_um.value(), drawn.gap->stated_sigma_um.value(),
              0.5 * drawn.gap->stated_sigma_um.value());
}

// Three sigmas of independent noise hold 99.7 %; along a path of few millimetres one pattern of speckle is
// several hundredths of it.
TEST(StatedUncertainty, OfAFollowedGapHoldsTheTruthOfAMachineAsDrawn) {
  const Record drawn = bottle("nominal", 3, "continuous");
  ASSERT_TRUE(drawn.gap);
  EXPECT_GT(drawn.gap->inside_stated_3_sigma_fraction.value(), 0.95);
  EXPECT_LT(drawn.gap->stated_sigma_um.value(), 10) << "wide enough for anything";
  ASSERT_EQ(drawn.gap_beliefs.size(), drawn.trace.size());
}

}  // namespace
}  // namespace understudy::rehearsal
