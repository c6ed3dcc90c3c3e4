#include "rehearsal/removal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using ::testing::HasSubstr;

std::string refusal(const SurfaceRequest& request, const char* machine = "finishing") {
  try {
    (void)prepare_workblank(request, machine::load_machine(machine));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

SurfaceRequest milled() {
  SurfaceRequest request;
  request.intended = "ellipse_50";
  request.depth_of_cut_mm = 0.7;
  return request;
}

TEST(Removal, TheStockIsThePartLargerByTheDepthOfCut) {
  const auto blank = prepare_workblank(milled(), machine::load_machine("finishing"));
  ASSERT_TRUE(blank);
  EXPECT_NEAR(to_mm(blank->part->upper().x()), 50, 1e-5);
  EXPECT_NEAR(to_mm(blank->stock->upper().x()), 50.7, 1e-3);
  EXPECT_NEAR(to_mm(blank->stock->upper().y()), 35.7, 1e-3);
  EXPECT_NEAR(to_mm(blank->stock->upper().z()), 30.7, 1e-9);
  EXPECT_NEAR(to_mm(blank->stock->lower().z()), 0, 1e-9);
  EXPECT_NEAR(to_mm(blank->mill.radius), 1.5, 1e-12);
  EXPECT_NEAR(to_mm(blank->mill.length), 30, 1e-12);
}

TEST(Removal, IsNotLookedAtUnlessAskedFor) {
  EXPECT_EQ(prepare_workblank({}, machine::load_machine("finishing")), nullptr);
  SurfaceRequest only_intended;
  only_intended.intended = "ellipse_50";
  EXPECT_EQ(prepare_workblank(only_intended, machine::load_machine("arm")), nullptr);
}

TEST(Removal, RefusesWhatIsNoWorkpiece) {
  EXPECT_THAT(refusal(milled(), "arm"), HasSubstr("arm prints"));
  SurfaceRequest request = milled();
  request.intended = "";
  EXPECT_THAT(refusal(request), HasSubstr("--intended PART"));
  request = milled();
  request.stock = "ellipse_75";
  EXPECT_THAT(refusal(request), HasSubstr("not both"));
  request.depth_of_cut_mm.reset();
  EXPECT_EQ(refusal(request), "accepted");
  request.stock = "no_such_part";
  EXPECT_THAT(refusal(request), HasSubstr("no_such_part"));
}

Record studied(const sim::RemovalSummary& summary) {
  TwinRun run;
  run.removal = summary;
  Record record;
  study_removal(run, {0.1e-3, 1}, record);
  return record;
}

TEST(Removal, DeepGougesAndWhatIsLeftOverAreFindings) {
  sim::RemovalSummary good;
  good.finished_fraction = 0.4;
  good.gouge = 0.09e-3;
  good.left_over_p95 = 0.08e-3;
  good.volume = 12e-9;
  const Record fine = studied(good);
  EXPECT_TRUE(fine.findings.empty());
  ASSERT_TRUE(fine.removal);
  EXPECT_NEAR(fine.removal->gouge_um, 90, 1e-9);
  EXPECT_NEAR(fine.removal->volume_mm3, 12, 1e-9);

  sim::RemovalSummary deep = good;
  deep.gouge = 0.25e-3;
  deep.gouge_place_W = Vec3(0.01, 0.02, 0.03);
  deep.gouge_line = 77;
  const Record gouged = studied(deep);
  ASSERT_EQ(gouged.findings.size(), 1u);
  EXPECT_EQ(gouged.findings[0].kind, "gouge");
  EXPECT_EQ(gouged.findings[0].severity, Severity::error);
  EXPECT_EQ(gouged.findings[0].gcode_line, 77);
  EXPECT_THAT(gouged.findings[0].message, HasSubstr("0.250 mm into the part at (10.00, 20.00, 30.00) mm"));

  sim::RemovalSummary rough = good;
  rough.left_over_p95 = 0.2e-3;
  const Record left = studied(rough);
  ASSERT_EQ(left.findings.size(), 1u);
  EXPECT_EQ(left.findings[0].kind, "left_over");
  EXPECT_EQ(left.findings[0].severity, Severity::warning);

  const Record air = studied({});
  ASSERT_EQ(air.findings.size(), 1u);
  EXPECT_EQ(air.findings[0].severity, Severity::error);
  EXPECT_THAT(air.findings[0].message, HasSubstr("takes nothing off"));
}

}  // namespace
}  // namespace understudy::rehearsal
