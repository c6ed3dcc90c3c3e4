#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/file/number_table.h"
#include "tests/property.h"

namespace understudy {
namespace {

TEST(NumberTableProperties, NumbersReadBackToTheLastBitWhateverStandsAroundThem) {
  property::check({1000, 40}, [] {
    const int columns = *property::whole(1, 7);
    std::vector<std::string> header;
    for (int c = 0; c < columns; ++c) header.push_back(fmt::format("c{}_mm", c));
    const auto blanks = [] { return std::string(static_cast<std::size_t>(*property::whole(0, 2)), ' '); };
    std::string text = fmt::format("{}\n", fmt::join(header, ","));
    std::vector<NumberRow> rows;
    int line = 1;
    for (int n = *rc::gen::inRange(0, 12); n > 0; --n) {
      for (int more = *property::whole(0, 2); more > 0; --more, ++line)
        text += *rc::gen::element<std::string>("\n", "# a comment, 3\n", "   \n");
      NumberRow row;
      row.line = ++line;
      for (int c = 0; c < columns; ++c) {
        const double value =
            std::bit_cast<double>(*rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>()));
        row.values.push_back(std::isfinite(value) ? value : *property::real(-1e3, 1e3));
        text += blanks() + fmt::format("{}", row.values.back()) + blanks() + (c + 1 < columns ? "," : "");
      }
      text += *rc::gen::element<std::string>("\n", "\r\n");
      rows.push_back(row);
    }
    if (!rows.empty() && *property::whole(0, 3) == 0) text.pop_back();  // no newline at the end
    RC_LOG() << text << "\n";
    std::istringstream in(text);
    const std::vector<NumberRow> read = read_number_table(in, "t.csv", header);
    RC_ASSERT(read.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      RC_ASSERT(read[i].line == rows[i].line);
      RC_ASSERT(read[i].values == rows[i].values);
    }
  });
}

}  // namespace
}  // namespace understudy
