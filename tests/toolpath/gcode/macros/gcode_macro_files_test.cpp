// Syntax: Klipper, "Config reference", [include].
#include <filesystem>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/complaint.h"
#include "tests/temporary_folder.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/macros/gcode_macros.h"

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> texts(const std::vector<MacroLine>& lines) {
  std::vector<std::string> result;
  for (const MacroLine& line : lines) result.push_back(line.text);
  return result;
}

class IncludedMacros : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    write_file(folder_ / name, text);
    return (folder_ / name).string();
  }
  std::string complaint_of(const std::string& text) {
    const std::string path = write("printer.cfg", text);
    return complaint([&] { GcodeMacros::read(path); });
  }
  TemporaryFolder folder_;
};

TEST_F(IncludedMacros, IncludedFilesAreReadAndTheLastOfAMacroCounts) {
  write("macros/a.cfg", "[gcode_macro A]\ngcode:\n G0 X1\n");
  write("macros/b.cfg", "[include ../c.cfg]\n[gcode_macro B]\ngcode:\n G0 X2\n");
  write("c.cfg", "[gcode_macro C]\ngcode:\n G0 X3\n[gcode_macro D]\ngcode: G0 X4\n");
  const GcodeMacros macros =
      GcodeMacros::read(write("printer.cfg",
                              "[include macros/*.cfg]\n[include none/*.cfg]\n[gcode_macro C]\nvariable_x: 1\n"
                              "[gcode_macro D]\ngcode: G0 X5\n"));
  MacroBudget left;
  EXPECT_THAT(texts(macros.expand("A", "A", left)), ElementsAre("G0 X1"));
  EXPECT_THAT(texts(macros.expand("B", "B", left)), ElementsAre("G0 X2"));
  EXPECT_THAT(texts(macros.expand("C", "C", left)), ElementsAre("G0 X3"))
      << "the later section says no gcode";
  EXPECT_THAT(texts(macros.expand("D", "D", left)), ElementsAre("G0 X5"));
  ASSERT_EQ(macros.files().size(), 4u);
  EXPECT_THAT(macros.files()[macros.expand("C", "C", left)[0].file], HasSubstr("c.cfg"));
  GcodeOptions options;
  write("c.cfg", "[gcode_macro C]\ngcode:\n G0 X- \n");
  options.macros = std::make_shared<GcodeMacros>(GcodeMacros::read(folder_ / "printer.cfg"));
  EXPECT_THAT(complaint([&] { parse_gcode("C\n", "p.gcode", options); }),
              testing::ContainsRegex("p.gcode:1: in C \\(.*c.cfg:3\\): 'X-'"));
}

TEST_F(IncludedMacros, AreRefusedWhereTheyAreLargerThanAnyConfiguration) {
  const std::string half(kMacroFilesMax / 2, '#');
  write("a.cfg", half);
  EXPECT_EQ(complaint_of("[include a.cfg]\n"), "accepted");
  EXPECT_THAT(complaint_of("[include a.cfg]\n" + half),
              HasSubstr("a.cfg: more than 16000000 bytes in all that"));
}

TEST_F(IncludedMacros, FilesThatAreNotThereLieOutsideOrIncludeThemselvesAreRefused) {
  EXPECT_THAT(complaint_of("\n[include none.cfg]\n"),
              HasSubstr("printer.cfg:2: [include none.cfg]: there is no such file"));
  EXPECT_THAT(complaint_of("[include]\n"), HasSubstr("there is no such file"));
  EXPECT_THAT(complaint_of("[include printer.cfg]\n"), HasSubstr("includes itself"));
  write("a.cfg", "[include b.cfg]\n");
  write("b.cfg", "[include *.cfg]\n");
  EXPECT_THAT(complaint_of("[include a.cfg]\n"), HasSubstr("b.cfg:1: [include *.cfg] includes itself"));
  EXPECT_THAT(complaint_of("[include /etc/hosts]\n"), HasSubstr("there is no such file"));
  EXPECT_THAT(complaint_of("[include ../*]\n"), HasSubstr("lies outside the folder of"));
}

}  // namespace
}  // namespace understudy::toolpath
