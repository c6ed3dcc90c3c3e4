#include "rehearsal/inspection/extruder_letter.h"

#include <array>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "control/program/rotary_words.h"
#include "machine/description.h"

namespace understudy::rehearsal {
namespace {

/// A square, round and round; `words` of each side, of the length of path so far [mm].
template <typename Words>
std::string rounds(const Words& words) {
  std::string text = "G21\nG90\nG1 X0 Y0 Z0.2 F1800\n";
  constexpr std::array kCorners{"X20 Y0", "X20 Y20", "X0 Y20", "X0 Y0"};
  for (int i = 0; i < 16; ++i)
    text += fmt::format("G1 {} {}\n", kCorners[static_cast<std::size_t>(i % 4)], words(i));
  return text;
}

std::optional<char> letter_of(const std::string& text, const std::string& machine) {
  toolpath::GcodeOptions options;
  options.rotary = control::rotary_words(machine::load_machine(machine));
  return extruder_letter_of(text, "p.gcode", options, 1.75e-3);
}

TEST(ExtruderLetter, IsTheOneThatGrowsEvenlyAlongThePath) {
  EXPECT_EQ(letter_of(rounds([](int i) { return fmt::format("A{:.3f}", 0.8 * (i + 1)); }), "corexy"), 'A');
  EXPECT_EQ(letter_of(rounds([](int i) { return fmt::format("B{:.3f}", 0.8 * (i + 1)); }), "corexy"), 'B');
}

TEST(ExtruderLetter, ALetterThatTurnsAnAxisFeedsNothing) {
  const auto even = [](int i) { return fmt::format("A{:.3f}", 0.8 * (i + 1)); };
  EXPECT_EQ(letter_of(rounds(even), "trunnion-ac"), std::nullopt);
  const auto turns = [](int i) { return fmt::format("A{}", i % 3 == 0 ? 30 : 30 + 7 * i % 11); };
  EXPECT_EQ(letter_of(rounds(turns), "corexy"), std::nullopt);
  const auto thick = [](int i) { return fmt::format("A{}", 400 * (i + 1)); };  // a turn and more each side
  EXPECT_EQ(letter_of(rounds(thick), "corexy"), std::nullopt);
}

}  // namespace
}  // namespace understudy::rehearsal
