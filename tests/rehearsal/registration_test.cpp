// A part that stands beside where it was drawn, found by the gap sensor of the twin and printed on.
#include "rehearsal/registration.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/registration/part_pose_file.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/fixture_file.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using ::testing::HasSubstr;

/// The bottle's line on the machine as drawn; the gap is not controlled.
RehearsalRequest bottle() {
  RehearsalRequest request;
  request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  request.fixture = "bottle";
  request.engine = "quasistatic";
  request.as_built = "nominal";
  request.gap_control = "off";
  request.keep_scene = false;
  return request;
}

/// A machine as drawn on which the part is clamped 0.35 mm low, 0.3 mm aside and turned by 4 and 5 mrad.
struct MovedPart {
  MovedPart() {
    write_file(path,
               "part: {position_mm: [0.3, -0.2, -0.35], quaternion: [0.999994875, 0.002, 0, 0.0025]}\n");
  }
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "moved.yaml";
};

TEST(RegisteredRehearsal, PrintsInTheBandOnAPartThatStandsBesideItsPlace) {
  const MovedPart moved;
  RehearsalRequest request = bottle();
  request.as_built = moved.path.string();
  const Record without = rehearse(request);
  ASSERT_TRUE(without.gap);
  EXPECT_EQ(without.gap->in_band_fraction, 0);
  EXPECT_FALSE(without.registration);

  request.registration.wanted = true;
  const Record record = rehearse(request);
  ASSERT_TRUE(record.registration);
  const RegistrationFigures& found = *record.registration;
  EXPECT_EQ(found.refused, "");
  EXPECT_EQ(found.places, 9);
  ASSERT_TRUE(found.normal_error_rms_um);
  EXPECT_LE(found.normal_error_max_um, 20);
  ASSERT_TRUE(record.gap);
  EXPECT_GE(record.gap->in_band_fraction, 0.99);
  EXPECT_TRUE(record.go);
  // 0.35 mm low, as the tool meets it.
  EXPECT_NEAR(found.shift_um[2], -350, 40);
  for (const TracePoint& p : record.trace) ASSERT_GT(p.gap, 0.05e-3) << "at " << p.time;
}

// What was found once serves another print: the same file, told to a rehearsal that does not look.
TEST(RegisteredRehearsal, APoseFromAFilePutsProgramAndBeliefWhereThePartStands) {
  const MovedPart moved;
  RehearsalRequest request = bottle();
  request.as_built = moved.path.string();
  const std::string file = (moved.folder / "told-pose.yaml").string();
  control::PartPose pose;
  // As MovedPart has it.
  pose.X_W = make_pose(Quat(0.999994875, 0.002, 0, 0.0025).normalized(), Vec3(0.3e-3, -0.2e-3, -0.35e-3));
  pose.covariance = 1e-12 * Mat6::Identity();
  write_file(file, control::write_part_pose(pose, "by hand"));
  request.part_pose = file;
  const Record told = rehearse(request);
  request.part_pose.clear();
  request.as_built = "nominal";
  const Record in_place = rehearse(request);
  ASSERT_TRUE(told.gap && in_place.gap);
  EXPECT_FALSE(told.registration);
  // The machine is as drawn: play changes sides and a microstep rounds by some micrometres elsewhere.
  EXPECT_NEAR(told.gap->path_min_mm, in_place.gap->path_min_mm, 0.010);
  EXPECT_NEAR(told.gap->path_max_mm, in_place.gap->path_max_mm, 0.010);
  EXPECT_EQ(told.go, in_place.go);
}

// Waves of 0.3 mm, where the tolerances speak of 10 um: no pose of the drawn bottle explains them.
TEST(RegisteredRehearsal, AWarpedPartIsRefused) {
  const MovedPart warped;
  write_file(warped.path, "part: {ripple_um: 300}\n");
  RehearsalRequest request = bottle();
  request.program.clear();  // looked at all over
  request.as_built = warped.path.string();
  request.registration.wanted = true;
  const Record record = rehearse(request);
  ASSERT_TRUE(record.registration);
  EXPECT_THAT(record.registration->refused, HasSubstr("do not fit the drawn part"));
  EXPECT_FALSE(record.go);
  ASSERT_FALSE(record.findings.empty());
  EXPECT_EQ(record.findings[0].kind, "registration");
}

TEST(RegisteredRehearsal, APartThatIsRefusedIsAFinding) {
  RehearsalRequest request = bottle();
  const auto machine = machine::load_machine("hexapod");
  const auto part = geometry::read_stl(machine::find_fixture("bottle"));
  request.registration.wanted = true;
  auto task = registration_task(request, machine, part, {});
  ASSERT_TRUE(task);
  RegistrationRun run;
  run.found.refused = "the readings do not fit the drawn part";
  EXPECT_FALSE(run.good());
  const auto findings = registration_findings(run);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, "registration");
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_THAT(findings[0].message, HasSubstr("do not fit"));
  EXPECT_EQ(registration_figures(run, *task).refused, run.found.refused);
}

TEST(RegisteredRehearsal, NeedsAPartAndASensor) {
  RehearsalRequest request = bottle();
  request.registration.wanted = true;
  const auto machine = machine::load_machine("hexapod");
  EXPECT_THROW(registration_task(request, machine, nullptr, {}), InputError);
  auto blind = machine;
  blind.has_microscope = false;
  EXPECT_THROW(registration_task(request, blind, geometry::read_stl(machine::find_fixture("bottle")), {}),
               InputError);
  request.registration.wanted = false;
  EXPECT_FALSE(registration_task(request, machine, nullptr, {}));
}

}  // namespace
}  // namespace understudy::rehearsal
