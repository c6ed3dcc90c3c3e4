#include "toolpath/inspection/comments.h"

#include "core/text/take_line.h"
#include "core/text/trimmed.h"

namespace understudy::toolpath {

void for_each_comment(std::string_view text,
                      const std::function<void(int line, std::string_view comment)>& see) {
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view words = trimmed(take_line(text));
    if (words.starts_with(';')) see(line, trimmed(words.substr(1)));
  }
}

}  // namespace understudy::toolpath
