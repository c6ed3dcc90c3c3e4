#include "cli/options/seed_option.h"

#include <charconv>
#include <cstdint>
#include <string>

namespace understudy::cli {

CLI::Validator seed_check() {
  return {[](std::string& word) {
            std::uint64_t seed = 0;
            const char* const end = word.data() + word.size();
            const auto read = std::from_chars(word.data(), end, seed);
            return read.ec == std::errc() && read.ptr == end
                       ? std::string()
                       : "a seed is a whole number from 0 to 18446744073709551615, not " + word;
          },
          "UINT64"};
}

}  // namespace understudy::cli
