// The answer in a word and in a sentence.
#pragma once

#include <optional>
#include <string>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// A go with warnings is a go: exit status 0.
enum class Grade { go, go_with_warnings, no_go };
Grade grade_of(const Record& record);
const char* word(Grade grade);  ///< of files: "go", "go-with-warnings", "no-go"
/// Of such a word; nothing for another.
std::optional<Grade> grade_of_word(const std::string& word);
const char* headline(Grade grade);  ///< "GO", "GO with warnings", "NO-GO"

/// For people: why it is a go, or what stands against it.
std::string verdict_sentence(const Record& record);

}  // namespace understudy::rehearsal
