#include "toolpath/inspection/layer_comments.h"

#include <algorithm>
#include <cctype>

#include "core/text/trimmed.h"

namespace understudy::toolpath {
namespace {

bool begins_layer(std::string_view comment) {
  if (comment == "LAYER_CHANGE" || comment == "CHANGE_LAYER" || comment.starts_with("LAYER:")) return true;
  comment.remove_prefix(std::min(comment.find_first_not_of("- "), comment.size()));
  constexpr std::string_view kNumbered = "layer ";
  return comment.starts_with(kNumbered) && comment.size() > kNumbered.size() &&
         std::isdigit(static_cast<unsigned char>(comment[kNumbered.size()])) != 0;
}

}  // namespace

LayerComments::LayerComments(std::string_view text) {
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view words = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!words.starts_with(';')) continue;
    words.remove_prefix(std::min(words.find_first_not_of("; \t"), words.size()));
    if (begins_layer(words)) lines_.push_back(line);
  }
}

int LayerComments::at(int line) const {
  return static_cast<int>(std::ranges::upper_bound(lines_, line) - lines_.begin());
}

}  // namespace understudy::toolpath
