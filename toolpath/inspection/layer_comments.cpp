#include "toolpath/inspection/layer_comments.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "toolpath/inspection/comments.h"

namespace understudy::toolpath {
namespace {

bool begins_layer(std::string_view comment) {
  if (comment == "LAYER_CHANGE" || comment == "CHANGE_LAYER" || comment.starts_with("LAYER:")) return true;
  comment.remove_prefix(std::min(comment.find_first_not_of("- "), comment.size()));
  constexpr std::string_view kNumbered = "layer ";
  return comment.starts_with(kNumbered) && comment.size() > kNumbered.size() &&
         std::isdigit(static_cast<unsigned char>(comment[kNumbered.size()])) != 0;
}

/// 0 where the comment has none.
int number_in(std::string_view comment) {
  std::size_t at = comment.find_first_of("0123456789");
  if (at == std::string_view::npos) return 0;
  if (at > 0 && comment[at - 1] == '-') --at;
  comment.remove_prefix(at);
  int number = 0;
  std::from_chars(comment.data(), comment.data() + comment.size(), number);
  return number;
}

}  // namespace

LayerComments::LayerComments(std::string_view text) {
  for_each_comment(text, [this](int line, std::string_view comment) {
    comment.remove_prefix(std::min(comment.find_first_not_of("; \t"), comment.size()));
    if (!begins_layer(comment)) return;
    if (lines_.empty()) first_number_ = number_in(comment);
    lines_.push_back(line);
  });
}

int LayerComments::first() const { return lines_.empty() || first_number_ > 1 ? 0 : lines_.front(); }

int LayerComments::at(int line) const {
  return static_cast<int>(std::ranges::upper_bound(lines_, line) - lines_.begin());
}

}  // namespace understudy::toolpath
