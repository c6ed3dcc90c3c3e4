#include "toolpath/robot/rapid_reader.h"

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

const std::string kExternal = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
/// A target whose tool points down: half a turn about y.
std::string at(double x, double y, double z) {
  return "[[" + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "],[0,0,1,0]," +
         kExternal;
}

RobotOptions options() {
  RobotOptions o;
  o.X_WT_home = make_pose(Quat::Identity(), Vec3(0, 0, 60e-3));
  o.extruder.bead_area = 0.0914159265358979e-6;  // 0.5 x 0.2 mm
  return o;
}

std::vector<Step> steps_of(const std::string& body, const std::string& data = "",
                           const RobotOptions& o = options()) {
  return parse_rapid("MODULE Part\n" + data + "PROC main()\n" + body + "ENDPROC\nENDMODULE\n", "part.mod", o)
      .steps;
}

std::string rejection(const std::string& body, const std::string& data = "",
                      const RobotOptions& o = options()) {
  try {
    steps_of(body, data, o);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Vec3 tip_mm(const Step& step) { return 1e3 * step.X_WT.translation(); }

TEST(RapidReader, ALineWithTheSignalOnPrintsInTheTimeOfItsSpeed) {
  const auto steps =
      steps_of("ConfL\\Off;\nMoveJ " + at(0, 0, 5) + ",v100,z1,tool0;\nSetDO doExtrude,1;\nMoveL " +
               at(100, 0, 5) + ",v20,fine,tool0\\WObj:=wobj0;\nSetDO doExtrude,0; MoveL " + at(100, 0, 25) +
               ",[50,500,5000,1000],fine,tool0;\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[1].kind, StepKind::print);
  EXPECT_EQ(steps[1].line, 6);
  EXPECT_EQ(steps[2].line, 7);
  EXPECT_NEAR(least_duration(steps[1], steps[0].X_WT.translation()), 5, 1e-9) << "100 mm at 20 mm/s";
  EXPECT_NEAR(to_mm(steps[1].filament), 3.80063, 1e-5);
  EXPECT_NEAR(steps[2].feed, 0.05, 1e-12);
  EXPECT_TRUE(steps[1].X_WT.linear().isApprox(Mat3::Identity(), 1e-9)) << "half a turn about y is upright";
}

TEST(RapidReader, AnAnalogueSignalFeedsByTimeAndIsGatedByASwitchedOne) {
  auto o = options();
  o.extruder.bead_area.reset();
  o.extruder.flow_per_unit = 4e-9;  // 4 mm3/s for 1
  const auto steps = steps_of("MoveJ " + at(0, 0, 5) + ",v100,z1,tool0;\nSetAO aoRate,0.5;\nMoveL " +
                                  at(10, 0, 5) + ",v20,z1,tool0;\nSet doOn;\nMoveL " + at(110, 0, 5) +
                                  ",v20,z1,tool0;\nWaitTime\\InPos,2;\nReset doOn;\nMoveL " + at(0, 0, 5) +
                                  ",v20,z1,tool0;\n",
                              "", o);
  ASSERT_EQ(steps.size(), 5u);
  EXPECT_EQ(steps[1].kind, StepKind::move);
  // 0.5 x 4 mm3/s in 5 s are 10 mm3, of filament with a section of 2.405282 mm2.
  EXPECT_NEAR(to_mm(steps[2].filament), 10 / 2.405282, 1e-5);
  EXPECT_EQ(steps[3].kind, StepKind::print) << "it feeds at rest, too";
  EXPECT_NEAR(to_mm(steps[3].filament), 4 / 2.405282, 1e-5);
  EXPECT_EQ(steps[4].kind, StepKind::move);
}

TEST(RapidReader, WorkObjectsStandWhereTheirFramesPutThem) {
  // The second stands 100 mm along x of the first and is turned by 90 degrees about z.
  const std::string data =
      "PERS wobjdata one:=[FALSE,TRUE,\"\",[[500,0,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "TASK PERS wobjdata "
      "two:=[FALSE,TRUE,\"\",[[500,0,200],[1,0,0,0]],[[100,0,0],[0.7071068,0,0,0.7071068]]];\n";
  const auto steps = steps_of("MoveJ " + at(0, 0, 5) + ",v100,z1,tool0\\WObj:=one;\nSetDO d,1;\nMoveL " +
                                  at(10, 0, 5) + ",v20,z1,tool0\\WObj:=one;\nSetDO d,0;\nMoveL " +
                                  at(10, 0, 5) + ",v20,z1,tool0\\WObj:=two;\n",
                              data);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_TRUE(tip_mm(steps[1]).isApprox(Vec3(10, 0, 5), 1e-6)) << "the part stands in the first";
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(100, 10, 5), 1e-6));
  EXPECT_THAT(rejection("MoveJ " + at(0, 0, 5) + ",v100,z1,tool0\\WObj:=one;\nMoveL " + at(1, 0, 5) +
                            ",v20,z1,tool0\\WObj:=three;\n",
                        data),
              HasSubstr("base 'three' is used beside 'one', but where they stand"));
}

TEST(RapidReader, AWorkObjectThatIsNowhereIsRefused) {
  // Each frame alone is a number; the place of the target is none.
  const std::string said =
      rejection("MoveL " + at(0, 0, 5) + ",v20,z1,tool0\\WObj:=far;\n",
                "PERS wobjdata far:=[FALSE,TRUE,\"\",[[500,0,200],[1,0,0,0]],[[0,1e300,0],[1,0,0,0]]];\n");
  EXPECT_THAT(said, HasSubstr("part.mod:4: a coordinate of base 'far' of 1e+300 mm is beyond 100000 mm"));
}

TEST(RapidReader, TargetsAreNamedMovedAndReckonedWith) {
  const std::string data = "CONST robtarget p10:=" + at(1, 2, 3) + ";\nVAR robtarget row{2}:=[" +
                           at(5, 0, 5) + "," + at(6, 0, 5) +
                           "];\nCONST num step:=2*2.5;\nVAR speeddata slow:=[12,500,5000,1000];\n";
  const auto steps = steps_of(
      "VAR robtarget p;\nMoveL p10,slow,z1,tool0;\nMoveL Offs(p10,step,0,-1),v100\\V:=33,z1,tool0;\n"
      "MoveL RelTool(p10,0,0,2),v100\\T:=4,z1,tool0;\nMoveL row{2},v100,z1,tool0;\n"
      "p:=p10;\np.trans.z:=p.trans.z+step;\nMoveL p,v100,z1,tool0;\nslow.v_tcp:=6;\nMoveL "
      "p10,slow,z1,tool0;\n",
      data);
  ASSERT_EQ(steps.size(), 6u);
  EXPECT_NEAR(steps[0].feed, 0.012, 1e-12);
  EXPECT_TRUE(tip_mm(steps[1]).isApprox(Vec3(6, 2, 2), 1e-9));
  EXPECT_NEAR(steps[1].feed, 0.033, 1e-12);
  EXPECT_TRUE(tip_mm(steps[2]).isApprox(Vec3(1, 2, 1), 1e-9)) << "z of the tool points down";
  EXPECT_EQ(steps[2].duration, 4);
  EXPECT_TRUE(tip_mm(steps[3]).isApprox(Vec3(6, 0, 5), 1e-9));
  EXPECT_TRUE(tip_mm(steps[4]).isApprox(Vec3(1, 2, 8), 1e-9));
  EXPECT_NEAR(steps[5].feed, 0.006, 1e-12);
}

TEST(RapidReader, RelToolTurnsAboutTheToolsOwnAxes) {
  const auto steps = steps_of("MoveL " + at(0, 0, 5) + ",v20,z1,tool0;\nMoveL RelTool(" + at(0, 0, 5) +
                              ",0,0,0\\Ry:=30),v20,z1,tool0;\n");
  ASSERT_EQ(steps.size(), 2u);
  // y of the tool is y of the base; z, which points down, goes by 30 degrees towards -x, the tool's x.
  const Vec3 axis = tool_axis(steps[1].X_WT);
  EXPECT_NEAR(axis.x(), 0.5, 1e-9);
  EXPECT_NEAR(axis.z(), std::sqrt(0.75), 1e-9);
}

TEST(RapidReader, MoveCIsAnArcAndMoveLdoSwitchesAtItsEnd) {
  const auto steps = steps_of("MoveLDO " + at(10, 0, 5) + ",v20,z1,tool0,doOn,1;\nMoveC " + at(0, 10, 5) +
                              "," + at(-10, 0, 5) + ",v20,z1,tool0;\n");
  ASSERT_GT(steps.size(), 20u);
  EXPECT_EQ(steps[0].kind, StepKind::move);
  double length = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].kind, StepKind::print);
    length += (tip_mm(steps[i]) - tip_mm(steps[i - 1])).norm();
  }
  EXPECT_NEAR(length, 31.4159, 31.4159 * 2e-4);
}

TEST(RapidReader, HeadersCommentsCallsAndHandlersOfErrorsAreRead) {
  const auto program = parse_rapid(
      "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n! a comment; with a semicolon\nMODULE M(SYSMODULE)\n"
      "PROC main()\n  MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;\n  layer;\n  "
      "layer;\n"
      "ERROR\n  Unheard x,y;\nENDPROC\nLOCAL PROC layer()\n  MoveL\n    " +
          at(1, 0, 5) + ", ! over lines\n    v20,z1,tool0;\n  RETURN;\n  MoveL " + at(9, 0, 5) +
          ",v20,z1,tool0;\nENDPROC\nENDMODULE\n",
      "m.prg", options());
  ASSERT_EQ(program.steps.size(), 3u);
  EXPECT_EQ(program.steps[0].kind, StepKind::home);
  EXPECT_EQ(program.steps[1].line, 15);
  EXPECT_TRUE(tip_mm(program.steps[2]).isApprox(Vec3(1, 0, 5), 1e-9));
}

TEST(RapidReader, UnknownInstructionsAreToldTogetherAndMayBeIgnored) {
  const std::string body =
      "MoveL " + at(1, 0, 5) +
      ",v20,z1,tool0;\nIF TestDI(a) THEN\nWaitDI a,0;\nENDIF\nIF x=1 GoHome;\nWaitDI b,1;\n"
      "FOR i FROM 1 TO 3 DO\nFOR j FROM 1 TO 3 DO\nWaitDI c,1;\nENDFOR\nENDFOR\nGrip 3;\n"
      "MoveL pFar,v20,z1,tool0;\nMoveL " +
      at(1, 0, 5) + ",v33,z1,tool0;\nOther;\n";
  EXPECT_EQ(rejection(body),
            "part.mod:4: unknown words 'IF' (2 lines from line 4), 'WAITDI' (1 line from line 8), 'FOR' (1 "
            "line from "
            "line 9), 'GRIP' (1 line from line 14), 'pFar' (1 line from line 15), 'v33' (1 line from line "
            "16), 'OTHER' "
            "(1 line from line 17): mend these lines, or pass over them by --ignore");
  auto o = options();
  o.ignored = {"IF", "WAITDI", "FOR", "GRIP", "PFAR", "V33", "OTHER"};
  EXPECT_EQ(steps_of(body, "", o).size(), 1u);
}

TEST(RapidReader, ATrackThatMovesIsToldAndMayBeIgnored) {
  const std::string on_track = "[[1,0,5],[0,0,1,0],[0,0,0,0],[700,9E9,9E9,9E9,9E9,9E9]]";
  const std::string body =
      "MoveL [[0,0,5],[0,0,1,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\nMoveL " + on_track +
      ",v20,z1,tool0;\n";
  EXPECT_THAT(rejection(body), HasSubstr("unknown word 'EAX_A' (1 line from line 4)"));
  auto o = options();
  o.ignored = {"EAX_A"};
  EXPECT_EQ(steps_of(body, "", o).size(), 2u);
}

TEST(RapidReader, WhatItCannotKnowIsAnErrorWithItsLine) {
  EXPECT_THAT(rejection("MoveL [[1,0,5],[0,0,2,0]," + kExternal + ",v20,z1,tool0;\n"),
              HasSubstr("part.mod:3: the quaternion [0,0,2,0] has length 2, not 1"));
  EXPECT_THAT(rejection("MoveL [[1,0],[0,0,1,0]," + kExternal + ",v20,z1,tool0;\n"),
              HasSubstr("a target needs"));
  EXPECT_THAT(rejection("MoveL " + at(1, 0, 5) + "\n"), HasSubstr("has no ';'"));
  EXPECT_THAT(rejection("MoveL " + at(1, 0, 5) + ";\n"), HasSubstr("1 arguments, 2 are needed"));
  EXPECT_THAT(rejection("main;\n"), HasSubstr("MAIN calls itself"));
  EXPECT_THAT(rejection("IF a THEN\n"), HasSubstr("IF has no ENDIF"));
  EXPECT_THAT(rejection("x:=" + std::string(100, '[') + ";\n"), HasSubstr("brackets nest more than 20 deep"));
  EXPECT_THAT(rejection("MoveL " + at(1, 0, 5) + ",v20,z1,held;\n",
                        "PERS tooldata held:=[FALSE,[[0,0,0],[1,0,0,0]]];\n"),
              HasSubstr("a tool that stands still"));
  for (const char* text : {"G1 X10 F600\n", "", "MODULE M\nENDMODULE\n"}) {
    try {
      parse_rapid(text, "a.mod", options());
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.mod"));
    }
  }
}

// Each takes a step of the stack when it ends.
TEST(RapidReader, ListsThatGrowDeeperWithEachLineAreRefused) {
  std::string body, parts = "a:=[0];\n";
  for (int i = 0; i < 100'000; ++i) {
    body += "a:=[a];\n";
    parts += "a.x:=a;\n";
  }
  EXPECT_EQ(rejection(body), "part.mod:23: lists nest more than 20 deep");
  EXPECT_EQ(rejection(parts), "part.mod:23: lists nest more than 20 deep");
}

TEST(RapidReader, ALongNameOfARoutineIsAnErrorWithItsLine) {
  EXPECT_EQ(rejection("ENDPROC\nPROC " + std::string(201, 'n') + "()\n"),
            "part.mod:4: a name of 201 characters");
}

TEST(RapidReader, WhichRoutineRunsIsMainOrTheOnlyOne) {
  const std::string move = "MoveL " + at(1, 0, 5) + ",v20,z1,tool0;\n";
  EXPECT_EQ(parse_rapid("MODULE M\nPROC Path_10()\n" + move + "ENDPROC\nENDMODULE\n", "a.mod", options())
                .steps.size(),
            1u);
  try {
    parse_rapid("MODULE M\nPROC b()\n" + move + "ENDPROC\nPROC a()\n" + move + "ENDPROC\nENDMODULE\n",
                "a.mod", options());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none is called main; there are A, B"));
  }
}

}  // namespace
}  // namespace understudy::toolpath
