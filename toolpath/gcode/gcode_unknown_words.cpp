#include "toolpath/gcode/gcode_unknown_words.h"

#include <string>

#include <fmt/format.h>

namespace understudy::toolpath {
namespace {

constexpr std::size_t kWordsShown = 20;

}  // namespace

void UnknownWords::add(const UnknownWord& error) {
  if (!first_) first_.emplace(error);
  const auto [known, fresh] = index_.try_emplace(error.word(), counts_.size());
  if (fresh)
    counts_.push_back({error.word(), 1, error.place().line});
  else
    ++counts_[known->second].lines;
}

void UnknownWords::fail_if_any() const {
  if (!first_) return;
  if (counts_.size() == 1 && counts_[0].lines == 1) throw UnknownWord(*first_);
  std::string all;
  for (std::size_t i = 0; i < counts_.size() && i < kWordsShown; ++i)
    all += fmt::format("{}'{}' ({} line{} from line {})", i ? ", " : "", counts_[i].word, counts_[i].lines,
                       counts_[i].lines == 1 ? "" : "s", counts_[i].first_line);
  if (counts_.size() > kWordsShown) all += fmt::format(" and {} more", counts_.size() - kWordsShown);
  throw InputError(first_->place(),
                   fmt::format("unknown words {}: mend these lines, or pass over them by --ignore", all));
}

}  // namespace understudy::toolpath
