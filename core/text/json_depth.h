// A look at JSON text before it is parsed: what is nested too deep overflows the stack of those that read it.
#pragma once

#include <string_view>

namespace understudy {

constexpr int kJsonDepthMax = 100;

/// Whether lists and objects of `text` are nested more than `limit` deep. The text need not be valid.
bool nests_deeper(std::string_view text, int limit = kJsonDepthMax);

}  // namespace understudy
