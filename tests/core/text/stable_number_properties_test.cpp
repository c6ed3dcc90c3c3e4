#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "core/text/stable_number.h"
#include "tests/property.h"

namespace understudy {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();

/// Any finite number, of any exponent as often as of any other, and some of the largest there are.
double drawn_number() {
  if (*property::whole(0, 9) == 9) return kLargest * *rc::gen::element(1.0, -1.0) * *property::real(0.999, 1);
  const auto bits = *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>());
  const double value =
      std::bit_cast<double>(bits ^ (static_cast<std::uint64_t>(*property::whole(0, 0x7fe)) << 52));
  RC_PRE(std::isfinite(value));
  return value;
}

TEST(StableNumberProperties, ItHasSoManyDigitsAndIsAsNearAsTheseCanBe) {
  property::check({3000}, [] {
    const double value = drawn_number();
    const int digits = *property::whole(1, 17);
    RC_LOG() << fmt::format("{} with {} digits\n", value, digits);
    const double found = stable_number(value, "x", digits);
    RC_ASSERT(std::isfinite(found));
    // No text of so many digits is nearer; half of a last digit is that of the number or of the power above.
    const double last = std::pow(10.0, std::floor(std::log10(std::abs(found))) + 1 - digits);
    const double rounding = 3e-16 * std::abs(found) + 5e-324;
    RC_ASSERT((value == 0 || last == 0 || std::abs(found - value) <= 0.5 * last + rounding));
    RC_ASSERT(stable_number(found, "x", digits) == found);
    RC_ASSERT(!(found == 0 && std::signbit(found)));
    RC_ASSERT(stable_number(-value, "x", digits) == -found);
  });
}

// A results file is read back to the number that was written.
TEST(StableNumberProperties, ItsShortestTextReadsBackAsTheSameAndIsNoLongerThanItsDigits) {
  property::check({3000}, [] {
    const int digits = *property::whole(1, 15);
    const double found = stable_number(drawn_number(), "x", digits);
    RC_PRE(std::abs(found) < 1e308);  // some beyond are not rounded
    const std::string text = fmt::format("{}", found);
    RC_LOG() << text << "\n";
    RC_ASSERT(std::strtod(text.c_str(), nullptr) == found);
    std::string mantissa = text.substr(0, text.find('e'));
    std::erase_if(mantissa, [](char c) { return c < '0' || c > '9'; });
    const auto first = mantissa.find_first_not_of('0'), end = mantissa.find_last_not_of('0');
    if (first != std::string::npos && std::abs(found) > 1e-300)
      RC_ASSERT(end - first + 1 <= static_cast<std::size_t>(digits));
  });
}

TEST(StableNumberProperties, OrderIsKept) {
  property::check({3000}, [] {
    const double a = drawn_number(), b = a * *property::real(0.99, 1.01);
    const int digits = *property::whole(1, 17);
    RC_PRE(std::isfinite(b));
    const double low = std::min(a, b), high = std::max(a, b);
    RC_ASSERT(stable_number(low, "x", digits) <= stable_number(high, "x", digits));
  });
}

}  // namespace
}  // namespace understudy
