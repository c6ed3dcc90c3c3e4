// Private to this folder: statements that a reader does not know, told together.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {

/// A statement, position or name that a reader does not know; `word` is what --ignore passes over.
class UnknownStatement : public InputError {
 public:
  UnknownStatement(const Place& place, const std::string& word);
  const std::string& word() const { return word_; }

 private:
  std::string word_;
};

class UnknownStatements {
 public:
  void add(const UnknownStatement& error);
  /// Throws InputError that names all of them.
  void fail_if_any() const;
  const std::vector<UnknownWordCount>& counts() const { return counts_; }

 private:
  Place first_;
  std::vector<UnknownWordCount> counts_;
  std::unordered_map<std::string, std::size_t> index_;
};

}  // namespace understudy::toolpath
