// Programs of robots, from outside: rehearse and inspect.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
using ::testing::HasSubstr;

// A square of 20 mm, a bead of 0.5 x 0.2 mm at 20 mm/s.
constexpr const char* kKrl =
    "&ACCESS RVP\nDEF square( )\nBAS (#INITMOV,0)\n$BASE={X 500,Y 0,Z 300,A 0,B 0,C 0}\n"
    "PTP {X 0,Y 0,Z 20,A 0,B 180,C 0}\n$VEL.CP=0.02\nLIN {Z 0.2}\n$OUT[1]=TRUE\nLIN {X 20} C_DIS\nLIN {Y 20} "
    "C_DIS\nLIN {X 0} C_DIS\nLIN {Y 0}\n$OUT[1]=FALSE\nLIN {Z 20}\nEND\n";
constexpr const char* kRapid =
    "MODULE Square\nPERS wobjdata table:=[FALSE,TRUE,\"\",[[500,0,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
    "CONST robtarget p0:=[[0,0,0.2],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\n"
    "MoveL Offs(p0,0,0,19.8),vmax,z1,tool0\\WObj:=table;\nMoveL p0,v20,fine,tool0\\WObj:=table;\nSetDO "
    "doPrint,1;\n"
    "MoveL Offs(p0,20,0,0),v20,z1,tool0\\WObj:=table;\nMoveL Offs(p0,20,20,0),v20,z1,tool0\\WObj:=table;\n"
    "MoveL Offs(p0,0,20,0),v20,z1,tool0\\WObj:=table;\nMoveL p0,v20,fine,tool0\\WObj:=table;\nSetDO "
    "doPrint,0;\n"
    "MoveL Offs(p0,0,0,19.8),v20,z1,tool0\\WObj:=table;\nENDPROC\nENDMODULE\n";
constexpr const char* kGcode =
    "M83\nG0 X0 Y0 Z20\nG1 Z0.2 F1200\nG1 X20 E0.760126\nG1 Y20 E0.760126\nG1 X0 E0.760126\nG1 Y0 "
    "E0.760126\nG1 Z20\n";
constexpr const char* kHow = " --machine arm --engine quasistatic --no-pictures --temperature 210 --out ";

std::string line_with(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? "no " + part : text.substr(at, text.find('\n', at) - at);
}

TEST(RobotPrograms, PrintAsTheSameMovesInGcodeDo) {
  const Folder folder;
  const Outcome gcode =
      understudy("rehearse " + folder.write("square.gcode", kGcode) + kHow + (folder / "g"));
  ASSERT_LE(gcode.status, 1) << gcode.err;
  ASSERT_THAT(gcode.out, HasSubstr("filament fed 3.0 mm"));
  for (const auto& program : {folder.write("square.src", kKrl), folder.write("square.mod", kRapid),
                              folder.write("square.txt", kKrl)}) {
    const Outcome robot = understudy("rehearse " + program + " --bead 0.5x0.2" + kHow + (folder / "r"));
    EXPECT_EQ(robot.status, gcode.status) << robot.err;
    for (const char* part : {"print time", "filament fed", "gap at the start", "tip error"})
      EXPECT_EQ(line_with(robot.out, part), line_with(gcode.out, part)) << program;
    EXPECT_EQ(robot.out.find("is read as KRL, as its content tells") != std::string::npos,
              program.ends_with(".txt"));
  }
}

TEST(RobotPrograms, InspectSaysWhatOneUsesAndHowToRehearseIt) {
  const Folder folder;
  std::string text = kKrl;
  text.insert(text.find("BAS"), "$OUT[9]=TRUE\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nWAIT FOR $IN[3]\n");
  const std::string program = folder.write("square.src", text);
  const Outcome seen = understudy("inspect " + program + " --machine arm");
  ASSERT_EQ(seen.status, 0) << seen.err;
  EXPECT_THAT(seen.out, HasSubstr("KRL, told by its ending: LIN 6, "));
  EXPECT_THAT(seen.out, HasSubstr("moves by base: $BASE 7"));
  EXPECT_THAT(seen.out, HasSubstr("speeds 20 to 20 mm/s"));
  EXPECT_THAT(seen.out, HasSubstr("z of its tool points out of the nozzle"));
  EXPECT_THAT(seen.out, HasSubstr("1 move by axis values, the first in line 4"));
  EXPECT_THAT(seen.out, HasSubstr("output OUT[1]: switched, set 2 times, 0 to 1"));
  EXPECT_THAT(seen.out, HasSubstr("filament is fed by OUT[1]"));
  EXPECT_THAT(seen.out, HasSubstr("unknown word 'WAIT_FOR': 1 line, the first is 5"));
  EXPECT_THAT(seen.out, HasSubstr("prints 4 moves from (0.00, 0.00, 0.20) to (20.00, 20.00, 0.20) mm"));
  const std::string command = line_with(seen.out, "understudy rehearse").substr(11);
  EXPECT_THAT(command, HasSubstr("--ignore WAIT_FOR --signal 'OUT[1]' --bead 0.48x0.2"));
  const Outcome rehearsed =
      understudy(command.substr(0, command.find(" --out")) +
                 " --engine quasistatic --no-pictures --temperature 210 --out " + (folder / "out"));
  EXPECT_LE(rehearsed.status, 1) << rehearsed.err << " is what the command that it says gives";
  EXPECT_THAT(rehearsed.out, HasSubstr("1 move by axis values goes to the home of arm"));
}

TEST(RobotPrograms, WhatIsNotKnownIsToldInOneLineWithWhatToDo) {
  const Folder folder;
  const std::string open = folder.write("open.src", kKrl);
  const Outcome bead = understudy("rehearse " + open + " --machine arm --out " + (folder / "no"));
  EXPECT_EQ(bead.status, 2);
  EXPECT_THAT(bead.err,
              HasSubstr("OUT[1] feeds filament, but how much the program does not say: add --bead"));
  EXPECT_THAT(bead.err, HasSubstr("`understudy inspect " + open + " --machine arm` shows what to do"));
  std::string text = kRapid;
  text.insert(text.find("SetDO doPrint,1"), "WaitDI diReady,1;\nGrip 3;\n");
  const Outcome unknown = understudy("rehearse " + folder.write("wait.txt", text) +
                                     " --bead 0.5x0.2 --machine arm --out " + (folder / "no"));
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("unknown words 'WAITDI' (1 line from line 7), 'GRIP' (1 line from line 8)"));
  const Outcome mixed =
      understudy("rehearse " + folder.write("a.gcode", kGcode) + " --bead 0.5x0.2 --out " + (folder / "no"));
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err, HasSubstr("are for KRL and RAPID, and this is G-code"));
  for (const char* words : {"--bead 0.5", "--bead 0.2x0.5", "--bead 0x0", "--flow 0", "--tool-points w"})
    EXPECT_EQ(understudy("rehearse " + open + " " + words + " --out " + (folder / "no")).status, 2) << words;
}

}  // namespace
}  // namespace understudy::cli_test
