#include "rehearsal/surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

/// A bead along x with a flat top 2 mm wide at z = 0.2 mm.
sim::Workpiece one_bead() {
  sim::Workpiece part(nullptr);
  sim::Bead bead;
  bead.from_W = {0, 0, 0.1e-3f};
  bead.to_W = {10e-3f, 0, 0.1e-3f};
  bead.width = 2.2e-3f;
  bead.height = 0.2e-3f;
  part.add(bead);
  return part;
}

std::string refusal(const SurfaceRequest& request) {
  try {
    (void)prepare_surface(request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

SurfaceRequest profile(std::vector<double> line_mm) {
  SurfaceRequest request;
  request.profile_mm = std::move(line_mm);
  return request;
}

TEST(Surface, WhatItIsAskedForIsCheckedBeforeAnythingRuns) {
  EXPECT_EQ(refusal({}), "accepted");
  EXPECT_FALSE(prepare_surface({}).wanted());
  EXPECT_EQ(refusal(profile({1, 0, 0, 9, 0, 0})), "accepted");
  EXPECT_THAT(refusal(profile({1, 0, 0, 9, 0})), HasSubstr("--profile: six numbers"));
  EXPECT_THAT(refusal(profile({1, 0, 0, 1, 0, 0.0005})), HasSubstr("--profile"));
  SurfaceRequest request;
  request.as_printed = "part.obj";
  EXPECT_EQ(refusal(request), "--as-printed part.obj: ends in neither .stl nor .ply");
  request.as_printed = "";
  request.probe = {0, 0, 0};
  EXPECT_THAT(refusal(request), HasSubstr("--probe"));
  request.probe = {0, 0, -1};
  request.intended = "no-such-part";
  EXPECT_THAT(refusal(request), HasSubstr("no-such-part"));
}

TEST(Surface, NothingAskedForLeavesTheRecordAlone) {
  Record record;
  study_surface(prepare_surface({}), one_bead(), record);
  EXPECT_FALSE(record.surface);
  EXPECT_TRUE(record.findings.empty());
}

TEST(Surface, ALineOnAFlatTopIsSmooth) {
  Record record;
  study_surface(prepare_surface(profile({2, 0, 0.2, 8, 0, 0.2})), one_bead(), record);
  ASSERT_TRUE(record.surface);
  // A bead's coordinates are floats: nanometres.
  EXPECT_NEAR(*record.surface->ra_um, 0, 0.01);
  EXPECT_NEAR(*record.surface->rz_um, 0, 0.01);
  EXPECT_FALSE(record.surface->deviation_p95_um) << "no part is intended";
  ASSERT_FALSE(record.profile.empty());
  EXPECT_LE(record.profile.size(), 4000u);
  EXPECT_EQ(record.profile.front()[0], 0);
  EXPECT_NEAR(record.profile.back()[0], 6, 0.01);
}

TEST(Surface, ALineBesideThePrintIsAWarningAndNoFailure) {
  Record record;
  study_surface(prepare_surface(profile({2, 50, 0.2, 8, 50, 0.2})), one_bead(), record);
  ASSERT_EQ(record.findings.size(), 1u);
  EXPECT_EQ(record.findings[0].severity, Severity::warning);
  EXPECT_EQ(record.findings[0].kind, "unreachable");
  EXPECT_THAT(record.findings[0].message, HasSubstr("the surface was not measured: "));
  EXPECT_FALSE(record.surface->ra_um);
}

TEST(Surface, ThePartAsPrintedIsWritten) {
  const TemporaryFolder folder;
  const auto path = folder / "surface.stl";
  SurfaceRequest request;
  request.as_printed = path.string();
  Record record;
  study_surface(prepare_surface(request), one_bead(), record);
  const auto written = geometry::read_stl(path);
  EXPECT_NEAR(written->upper().z(), 0.2e-3, 1e-8);
}

}  // namespace
}  // namespace understudy::rehearsal
