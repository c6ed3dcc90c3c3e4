// The section `gcode` of a machine file: what it maps, and its mistakes, each with file, line and value.
#include "machine/file/gcode_section.h"

#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kC = "{letter: C, axis: c}";

class GcodeSection : public EditedFile {
 protected:
  /// The five-axis printer with another word C, or with more keys behind the words.
  std::string word_c(const std::string& to) { return error_of(edited(text_, "gcode:", kC, to)); }
  std::string keys(const std::string& more) {
    return error_of(edited(text_, "gcode:", kC, std::string(kC) + "\n  " + more));
  }
  MachineDescription load(const std::string& to) {
    return load_machine(write(edited(text_, "gcode:", kC, to)));
  }
  std::string text_ = read_file(UNDERSTUDY_SOURCE_DIR "/models/five-axis/machine.yaml");
};

TEST_F(GcodeSection, MapsLettersToAxes) {
  const MachineDescription machine = load(
      "{letter: V, axis: c, sign: -1, zero_deg: 30, unit: revolutions}\n"
      "  extruder: A\n  tip_control_on: G43.4 m428 TRAORI\n  tip_control_off: M429");
  const auto& chain = machine.chain().kinematics;
  ASSERT_EQ(chain.turn_words.size(), 2u);
  ASSERT_EQ(chain.slide_words.size(), 3u);
  EXPECT_EQ(chain.turn_words[0].letter, 'B');
  EXPECT_EQ(chain.turn_words[1].letter, 'V');
  EXPECT_EQ(chain.turn_words[1].axis, 4u);
  EXPECT_EQ(chain.turn_words[1].sign, -1);
  EXPECT_DOUBLE_EQ(chain.turn_words[1].zero, from_deg(30));
  EXPECT_DOUBLE_EQ(chain.turn_words[1].home, from_deg(30));  // c is at 0, 30 deg before the word's 0
  EXPECT_DOUBLE_EQ(machine.dialect.turn_units[0], from_deg(1));
  EXPECT_DOUBLE_EQ(machine.dialect.turn_units[1], from_deg(360));
  EXPECT_EQ(machine.dialect.extruder_letter, 'A');
  EXPECT_EQ(machine.dialect.tip_control_on, (std::vector<std::string>{"G43.4", "M428", "TRAORI"}));
  EXPECT_EQ(machine.dialect.tip_control_off, std::vector<std::string>{"M429"});
}

TEST_F(GcodeSection, ALetterOrAnAxisTwice) {
  EXPECT_THAT(word_c("{letter: B, axis: c}"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("gcode.words[5].letter is 'B', as another word is")));
  EXPECT_THAT(word_c("{letter: C, axis: b}"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("gcode.words[5].axis is 'b', which B drives")));
}

TEST_F(GcodeSection, AnAxisThatIsNotThere) {
  EXPECT_THAT(
      word_c("{letter: C, axis: d}"),
      AllOf(HasSubstr(kInThatLine), HasSubstr("gcode.words[5].axis is 'd', not one of x, y, z, b, c")));
}

TEST_F(GcodeSection, ALetterThatProgramsUseOtherwise) {
  for (const std::string letter : {"F", "G", "E", "I", "N", "R", "T"})
    EXPECT_THAT(word_c("{letter: " + letter + ", axis: c}"),
                AllOf(HasSubstr(kInThatLine),
                      HasSubstr("gcode.words[5].letter is '" + letter + "', which means something else")));
  EXPECT_THAT(word_c("{letter: c, axis: c}"),
              HasSubstr("gcode.words[5].letter is 'c', not one of X Y Z A B"));
}

TEST_F(GcodeSection, ATurnForASlide) {
  EXPECT_THAT(error_of(edited(text_, "gcode:", "{letter: Z, axis: z}", "{letter: A, axis: z}")),
              HasSubstr("gcode.words[3].axis is 'z', which slides: A states turns"));
  EXPECT_THAT(error_of(edited(text_, "gcode:", "{letter: Z, axis: z}", "{letter: Z, axis: c}")),
              HasSubstr("gcode.words[3].axis is 'c', which turns: Z states a slide"));
}

TEST_F(GcodeSection, SlidesOnlyAllTogether) {
  EXPECT_THAT(error_of(edited(text_, "gcode:", "    - {letter: Y, axis: y}\n", "")),
              HasSubstr("gcode.words names 2 of X Y Z: all or none of them"));
}

TEST_F(GcodeSection, WordsThatLeaveTheTipOpen) {
  EXPECT_THAT(error_of(edited(text_, "gcode:", "    - {letter: C, axis: c}\n", "")),
              HasSubstr("gcode.words: axis c has no word and does not carry the tool alone"));
}

TEST_F(GcodeSection, ASignThatIsNone) {
  EXPECT_THAT(word_c("{letter: C, axis: c, sign: 0}"),
              AllOf(HasSubstr(kInThatLine), HasSubstr("gcode.words[5].sign is '0', not 1 or -1")));
  EXPECT_THAT(word_c("{letter: C, axis: c, sign: 2}"), HasSubstr("gcode.words[5].sign is 2"));
  EXPECT_THAT(word_c("{letter: C, axis: c, unit: gons}"), HasSubstr("gcode.words[5].unit is 'gons'"));
}

TEST_F(GcodeSection, KeysThatDoNotFit) {
  EXPECT_THAT(keys("pivot_mm: [0, 0, 1]"), HasSubstr("gcode.pivot_mm"));  // of crossing alone
  EXPECT_THAT(keys("extruder: B"), HasSubstr("gcode.extruder is 'B', which turns an axis"));
  EXPECT_THAT(keys("extruder: Q"), HasSubstr("gcode.extruder is 'Q', not one of E A B"));
  EXPECT_THAT(keys("tip_control_on: G43.4, M128"), HasSubstr("gcode.tip_control_on is 'G43.4, M128'"));
  EXPECT_THAT(keys("tip_control_on: M128\n  tip_control_off: M128"),
              HasSubstr("gcode.tip_control_off is 'M128', as tip_control_on is"));
  EXPECT_THAT(keys("tip_control_on: 128"), HasSubstr("where '128' is no command"));
}

TEST_F(GcodeSection, MachineCoordinatesNeedSlides) {
  std::string text = edited(text_, "gcode:", "coordinates: tip", "coordinates: machine");
  EXPECT_EQ(error_of(text), "accepted");
  for (const std::string slide : {"X, axis: x", "Y, axis: y", "Z, axis: z"})
    text = edited(text, "gcode:", "    - {letter: " + slide + "}\n", "");
  EXPECT_THAT(error_of(text), HasSubstr("gcode.coordinates is 'machine', but no words say which axes X Y Z"));
}

TEST_F(GcodeSection, MayBeLeftOut) {
  const auto begin = text_.find("gcode:"), end = text_.find("\ntool:");
  const MachineDescription machine = load_machine(write(text_.erase(begin, end - begin)));
  EXPECT_TRUE(machine.make_mechanism()->rotary_words().empty());
}

}  // namespace
}  // namespace understudy::machine
