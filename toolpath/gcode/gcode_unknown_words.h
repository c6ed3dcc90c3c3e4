// Words that the dialect does not know, told together.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

/// So that a user need not mend a program word by word.
class UnknownWords {
 public:
  void add(const UnknownWord& error);
  /// Throws InputError that tells all of them, UnknownWord where it is one.
  void fail_if_any() const;
  const std::vector<UnknownWordCount>& counts() const { return counts_; }

 private:
  std::optional<UnknownWord> first_;
  std::vector<UnknownWordCount> counts_;
  std::unordered_map<std::string, std::size_t> index_;  // of a word in counts_
};

}  // namespace understudy::toolpath
