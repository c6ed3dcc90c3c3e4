#include "toolpath/robot/unknown_statements.h"

#include <fmt/format.h>

namespace understudy::toolpath {
namespace {

constexpr std::size_t kShown = 20;

}  // namespace

UnknownStatement::UnknownStatement(const Place& place, const std::string& word)
    : InputError(place, "unknown word '" + word + "'"), word_(word) {}

void UnknownStatements::add(const UnknownStatement& error) {
  const auto [known, fresh] = index_.try_emplace(error.word(), counts_.size());
  if (counts_.empty()) first_ = error.place();
  if (fresh)
    counts_.push_back({error.word(), 1, error.place().line});
  else
    ++counts_[known->second].lines;
}

void UnknownStatements::fail_if_any() const {
  if (counts_.empty()) return;
  std::string all;
  for (std::size_t i = 0; i < counts_.size() && i < kShown; ++i)
    all += fmt::format("{}'{}' ({} line{} from line {})", i ? ", " : "", counts_[i].word, counts_[i].lines,
                       counts_[i].lines == 1 ? "" : "s", counts_[i].first_line);
  if (counts_.size() > kShown) all += fmt::format(" and {} more", counts_.size() - kShown);
  throw InputError(first_, fmt::format("unknown word{} {}: mend these lines, or pass over them by --ignore",
                                       counts_.size() == 1 ? "" : "s", all));
}

}  // namespace understudy::toolpath
