#include "core/assert.h"

#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

namespace understudy {

void fail_assertion(const char* condition, const char* file, int line, const char* why) {
  throw std::logic_error(fmt::format("{}:{}: {} does not hold: {}. This is a mistake of Understudy's own",
                                     std::filesystem::path(file).filename().string(), line, condition, why));
}

}  // namespace understudy
