#include "toolpath/robot/krl_reader.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/duration.h"
#include "toolpath/robot/robot_program.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

/// Beads of 0.5 x 0.2 mm; z of the tool points out of the nozzle.
RobotOptions options() {
  RobotOptions o;
  o.X_WT_home = make_pose(Quat::Identity(), Vec3(0, 0, 60e-3));
  o.extruder.bead_area = 0.0914159265358979e-6;
  o.tool_points = "z";
  return o;
}

std::vector<Step> steps_of(const std::string& body, const std::string& data = "",
                           const RobotOptions& o = options()) {
  return parse_krl("&ACCESS RVP\nDEF part( )\n" + body + "END\n", data, "part.src", o).steps;
}

std::string rejection(const std::string& body, const RobotOptions& o = options()) {
  try {
    steps_of(body, "", o);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Vec3 tip_mm(const Step& step) { return 1e3 * step.X_WT.translation(); }

TEST(KrlReader, ALineWithTheSignalOnPrintsInTheTimeOfItsSpeed) {
  const auto steps = steps_of(
      "BAS (#INITMOV,0)\n$VEL.CP=0.02 ; m/s\nLIN {X 0,Y 0,Z 5,A 0,B 0,C 180} C_DIS\n$OUT[3]=TRUE\n"
      "LIN {X 100,Y 0,Z 5,A 0,B 0,C 180} C_VEL\n$OUT[3]=FALSE\nLIN {X 100,Y 0,Z 25,A 0,B 0,C 180}\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].kind, StepKind::move);
  EXPECT_EQ(steps[1].kind, StepKind::print);
  EXPECT_EQ(steps[2].kind, StepKind::move);
  EXPECT_EQ(steps[1].line, 7);
  EXPECT_NEAR(least_duration(steps[1], steps[0].X_WT.translation()), 5, 1e-9) << "100 mm at 20 mm/s";
  // 0.3 mm x 0.2 mm and a circle of 0.2 mm across, out of filament of 1.75 mm.
  EXPECT_NEAR(to_mm(steps[1].filament), 3.80063, 1e-5);
  EXPECT_TRUE(steps[1].X_WT.linear().isApprox(Mat3::Identity(), 1e-9) ||
              tool_axis(steps[1].X_WT).isApprox(Vec3::UnitZ(), 1e-9));
}

TEST(KrlReader, WhatAPositionLeavesOutStaysAsItIs) {
  const auto steps = steps_of(
      "$VEL.CP=0.02\nPTP {X 10,Y 20,Z 30,A 0,B 0,C 180}\nLIN {Z 5}\nLIN_REL {X 2,Z 1}\n"
      "LIN_REL {Z 4} #TOOL\n");
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[0].kind, StepKind::travel);
  EXPECT_TRUE(tip_mm(steps[1]).isApprox(Vec3(10, 20, 5), 1e-9));
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(12, 20, 6), 1e-9));
  EXPECT_TRUE(tip_mm(steps[3]).isApprox(Vec3(12, 20, 2), 1e-9)) << "z of the tool points down";
}

TEST(KrlReader, PositionsAreDeclaredComposedAndReckonedWith) {
  const std::string data =
      "DEFDAT part PUBLIC\nDECL E6POS XP1={X 1.0,Y 2,Z 3,A 0,B 0,C 180,S 2,T 10,E1 0}\n"
      "DECL FDAT FP1={TOOL_NO 2,BASE_NO 4,IPO_FRAME #BASE,POINT2[] \" \"}\nENDDAT\n";
  const auto steps = steps_of(
      "DECL FRAME F\nDECL REAL step\nstep=2.5*2\nF={X 10,Y 0,Z 0,A 90,B 0,C 0}\n$VEL.CP=0.02\n"
      "FDAT_ACT=FP1\nBAS(#CP_PARAMS,0.04)\nLIN XP1 C_DIS\nLIN F:{X step,Y 0,Z 1,A 0,B 0,C 180}\n"
      "XP1.Z=XP1.Z+step\nLIN XP1\n",
      data);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_TRUE(tip_mm(steps[0]).isApprox(Vec3(1, 2, 3), 1e-9));
  EXPECT_NEAR(steps[0].feed, 0.04, 1e-12);
  // x of F is y of the base: 5 mm along it from (10, 0, 0).
  EXPECT_TRUE(tip_mm(steps[1]).isApprox(Vec3(10, 5, 1), 1e-9));
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(1, 2, 8), 1e-9));
}

TEST(KrlReader, APlaceThatIsTaughtIsTheOriginOfTheBase) {
  auto o = options();
  o.tool_points.clear();
  o.offset_W = Vec3(30e-3, 0, 0.2e-3);
  const auto moved = steps_of(
      "START=$POS_ACT\nPTP START\n$VEL.CP=0.01\nOFF={X 7,Y 0,Z 2,A 0,B 0,C 0}\nTARGET=START\n"
      "TARGET.X=START.X+OFF.X\nTARGET.Z=START.Z+OFF.Z\n$OUT[1]=TRUE\nLIN TARGET C_DIS\n",
      "", o);
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_TRUE(tip_mm(moved[1]).isApprox(Vec3(37, 0, 2.2), 1e-9));
  EXPECT_TRUE(tool_axis(moved[1].X_WT).isApprox(Vec3::UnitZ(), 1e-9));
}

TEST(KrlReader, ACircleGoesThroughItsPointAndAsFarAsCaSays) {
  const std::string start = "$VEL.CP=0.01\nPTP {X 10,Y 0,Z 5,A 0,B 0,C 180}\n$OUT[1]=TRUE\n";
  const auto half = steps_of(start + "CIRC {X 0,Y 10,Z 5},{X -10,Y 0,Z 5,A 0,B 0,C 180}\n");
  double length = 0, filament = 0;
  for (std::size_t i = 1; i < half.size(); ++i) {
    length += (tip_mm(half[i]) - tip_mm(half[i - 1])).norm();
    filament += to_mm(half[i].filament);
  }
  EXPECT_NEAR(length, 31.4159, 31.4159 * 2e-4);
  EXPECT_NEAR(filament, 31.4159 * 0.0380063, 1e-3);
  EXPECT_TRUE(tip_mm(half.back()).isApprox(Vec3(-10, 0, 5), 1e-9));
  const auto whole = steps_of(start + "CIRC {X 0,Y 10,Z 5},{X -10,Y 0,Z 5,A 0,B 0,C 180}, CA 360.0 C_DIS\n");
  EXPECT_TRUE(tip_mm(whole.back()).isApprox(Vec3(10, 0, 5), 1e-6));
}

TEST(KrlReader, TriggersSwitchAtTheStartAndAtTheEndOfTheNextMove) {
  const auto steps = steps_of(
      "$VEL.CP=0.01\nLIN {X 0,Y 0,Z 5,A 0,B 0,C 180}\n"
      "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE\nTRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=FALSE "
      "PRIO=-1\n"
      "LIN {X 10}\nLIN {X 20}\nWAIT SEC 2.5\n");
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[1].kind, StepKind::print);
  EXPECT_EQ(steps[2].kind, StepKind::move);
  EXPECT_EQ(steps[3].kind, StepKind::dwell);
  EXPECT_EQ(steps[3].duration, 2.5);
}

TEST(KrlReader, AxisValuesAndTheControllersHomeGoToTheMachinesHome) {
  const auto steps =
      steps_of("PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0,E1 0}\nPTP {X 1,Y 2,Z 3,A 0,B 0,C 180}\nPTP HOME\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].kind, StepKind::home);
  EXPECT_EQ(steps[2].kind, StepKind::home);
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(0, 0, 60), 1e-9));
  EXPECT_THAT(rejection("$VEL.CP=1\nLIN {A1 0,A2 0}\n"), HasSubstr("LIN takes X Y Z, not axis values"));
}

// What the controller's inline forms write, as in programs that were edited on it.
TEST(KrlReader, InlineFormsAreRead) {
  const auto steps = steps_of(
      "$BWDSTART=FALSE\nPDAT_ACT=PDEFAULT\nFDAT_ACT=FHOME\nBAS(#PTP_PARAMS,100)\n$H_POS=XHOME\nPTP XHOME\n"
      "LDAT_ACT=LCPDAT2\nFDAT_ACT=FP2\nBAS(#CP_PARAMS,0.5)\nLIN XP2\n"
      "SLIN XP2:{X 1} WITH $VEL=SVEL_CP(0.2, ,LCPDAT1),$TOOL=STOOL2(FP2),$BASE=SBASE(FP2.BASE_NO),"
      "$IPO_MODE=SIPO_MODE(FP2.IPO_FRAME),$LOAD=SLOAD(FP2.TOOL_NO),$ACC=SACC_CP(LCPDAT1)\n",
      "DEFDAT part\nDECL E6POS XP2={X 1,Y 2,Z 3,A 0,B 0,C 180}\nDECL FDAT FP2={TOOL_NO 8,BASE_NO 8,IPO_FRAME "
      "#BASE}\nENDDAT\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].kind, StepKind::home);
  EXPECT_EQ(steps[1].feed, 0.5);
  EXPECT_EQ(steps[2].feed, 0.2);
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(2, 2, 3), 1e-9));
}

TEST(KrlReader, RoutinesOfTheFileAreCalledAndSplinesAreRead) {
  const auto program = parse_krl(
      "DEF main( )\n$VEL.CP=0.01\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\nlayer( )\nlayer( )\nEND\n"
      "DEF layer( )\nSPLINE WITH $VEL.CP=0.05\nSLIN {X 10}\nSLIN {X 0} WITH "
      "$VEL.CP=0.02,$ACC.CP=1\nENDSPLINE\n"
      "RETURN\nLIN {X 99}\nEND\n",
      "", "main.src", options());
  ASSERT_EQ(program.steps.size(), 5u);
  EXPECT_EQ(program.steps[1].feed, 0.05);
  EXPECT_EQ(program.steps[2].feed, 0.02);
  EXPECT_EQ(program.steps[3].line, 9);
}

TEST(KrlReader, UnknownStatementsAreToldTogetherAndMayBeIgnored) {
  const std::string body =
      "$VEL.CP=0.01\nFOR I=1 TO 6\n$VEL_AXIS[I]=100\nENDFOR\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\n"
      "IF $IN[1]==TRUE THEN\nIF $IN[2] THEN\nHALT\nENDIF\nLIN {X 500}\nENDIF\nWAIT FOR $IN[4]\nGRIPPER(1)\n"
      "WAIT FOR $IN[5]\nLIN XP9\nLIN {X 1,Y 0,Z 5,A 0,B 0,C 180,E1 0}\nLIN {X 2,Y 0,Z 5,A 0,B 0,C 180,E1 "
      "400}\n";
  EXPECT_EQ(
      rejection(body),
      "part.src:8: unknown words 'IF' (1 line from line 8), 'WAIT_FOR' (2 lines from line 14), 'GRIPPER' (1 "
      "line from line 15), 'XP9' (1 line from line 17), 'E1' (1 line from line 19): mend these lines, or "
      "pass "
      "over them by --ignore");
  EXPECT_THAT(rejection("FOR I=1 TO 6\nLIN {X 1}\n$VEL_AXIS[I]=100\nENDFOR\n" + body),
              HasSubstr("unknown words 'FOR' (1 line from line 3)"))
      << "a loop that does more than set limits";
  auto o = options();
  o.ignored = {"IF", "WAIT_FOR", "GRIPPER", "XP9", "E1"};
  const auto steps = steps_of(body, "", o);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_TRUE(tip_mm(steps.back()).isApprox(Vec3(2, 0, 5), 1e-9));
}

TEST(KrlReader, WhatItCannotKnowIsAnErrorWithItsLine) {
  EXPECT_THAT(rejection("LIN {X 1,Y 0,Z 5,A 0,B 0,C 180}\n"),
              HasSubstr("part.src:3: a straight move before any speed"));
  EXPECT_THAT(rejection("$VEL.CP=1\nLIN {X 1,Y 0,Z 5}\n"), HasSubstr("part.src:4: A is left out, and where"));
  EXPECT_THAT(rejection("$VEL.CP=1\nLIN {X 1,Y 0,Z 5e9,A 0,B 0,C 0}\n"), HasSubstr("beyond 100000 mm"));
  EXPECT_THAT(rejection("$BASE={X 0,Y 2e5,Z 0,A 0,B 0,C 0}\nLIN {X 1,Y 0,Z 5,A 0,B 0,C 180}\n"),
              HasSubstr("a coordinate of base '$BASE' of 200000 mm is beyond 100000 mm"));
  EXPECT_THAT(rejection("$VEL.CP=1\nLIN {X 1,,Z 5}\n"), HasSubstr("the name of a component is expected"));
  EXPECT_THAT(rejection("$VEL.CP=1\nLIN {X 1.2.3}\n"), HasSubstr("the end of a number is expected"));
  EXPECT_THAT(rejection("$VEL.CP=0\nLIN {X 1,Y 0,Z 5,A 0,B 0,C 180}\n"), HasSubstr("before any speed"));
  EXPECT_THAT(rejection("$VEL.CP=1\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\n"
                        "CIRC {X 90000,Y 90000,Z 5},{X 1,Y 90000,Z 5,A 0,B 0,C 180}, CA 36000\n"),
              HasSubstr("part.src:5: an arc of 1.2530"));
  const std::string arcs =
      "$VEL.CP=1\nPTP {X 0,Y 0,Z 5,A 0,B 0,C 180}\n"
      "CIRC {X 5,Y 5},{X 10,Y 0}\nCIRC {X 5,Y 5},{X 0,Y 0}\n";
  auto few = options();
  few.chords_max = steps_of(arcs, "", few).size() - 2;
  EXPECT_THAT(rejection(arcs, few), HasSubstr("part.src:6: the program's arcs have more than"));
  EXPECT_THAT(rejection("WAIT SEC -1\n"), HasSubstr("outside 0..86400 s"));
  EXPECT_THAT(rejection("part( )\n"), HasSubstr("PART calls itself"));
  EXPECT_THAT(rejection("FOR I=1 TO 3\n"), HasSubstr("FOR has no ENDFOR"));
  EXPECT_THAT(rejection("WAIT SEC 1\n"), HasSubstr("0 moves, at least 1 is needed"));
  EXPECT_THAT(rejection("X=" + std::string(100, '(') + "\n"), HasSubstr("brackets nest more than 20 deep"));
  EXPECT_THAT(rejection(std::string(70'000, ' ') + "\n"),
              HasSubstr("the line has 70000 bytes, more than 65536"));
  EXPECT_THAT(rejection(std::string(1, '\x01') + "\n"), HasSubstr("byte 1 belongs to no program"));
  try {
    parse_krl("G1 X10 F600\n", "", "a.src", options());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.src: no DEF: a program in KRL has one");
  }
}

// Few characters copy a large structure: a program of 8 MB would need 20 GB.
TEST(KrlReader, VariablesThatNeedTooMuchMemoryAreRefused) {
  std::string body = "A={X 0";
  for (int i = 0; i < 60; ++i) body += ",N" + std::string(190, 'N') + std::to_string(i) + " 0";
  body += "}\n";
  for (int i = 0; i < 200; ++i) body += "B" + std::to_string(i) + "=A\n";
  auto few = options();
  few.variables_max = 2'000'000;
  EXPECT_THAT(rejection(body, few),
              testing::MatchesRegex("part.src:1[0-9]+: variables up to here need more than 2 MB"));
  few.variables_max = 4'000'000;
  EXPECT_THAT(rejection(body, few), HasSubstr("0 moves, at least 1 is needed"));
  std::string again = body.substr(0, body.find('\n') + 1);
  for (int i = 0; i < 1000; ++i) again += "B=A\nB=0\nB.X=1\n";
  EXPECT_THAT(rejection(again, few), HasSubstr("0 moves")) << "what they held before does not count";
}

// 2^20 lines of calls that call each other twice.
TEST(KrlReader, CallsThatMultiplyAreStopped) {
  std::string text = "DEF r0( )\nr1( )\nr1( )\nEND\n";
  for (int i = 1; i < 21; ++i)
    text += "DEF r" + std::to_string(i) + "( )\n" +
            (i < 20 ? "r" + std::to_string(i + 1) + "( )\nr" + std::to_string(i + 1) + "( )\n" : "HALT\n") +
            "END\n";
  try {
    parse_krl(text, "", "a.src", options());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("calls run more than 1000000 lines"));
  }
}

}  // namespace
}  // namespace understudy::toolpath
