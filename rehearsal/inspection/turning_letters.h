// Which letters of a program turn axes, as far as its text tells.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace understudy::rehearsal {

/// The letters of words with a number on lines of G commands, outside of comments.
std::set<char> letters_of(std::string_view text);

/// Out of toolpath::kRotaryLetters, those of lines that move: W beside I J K is a quaternion's, and the words
/// of G28 and of levelling (G29 P9 X120 W32) turn nothing. None where all of them stay 0, and of more than
/// two those that do not.
std::string turning_letters(std::string_view text, char extruder);

/// `text` without the words of these letters, outside of comments.
std::string without_words(std::string_view text, std::string_view letters);

}  // namespace understudy::rehearsal
