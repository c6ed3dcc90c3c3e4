#include "core/error_context.h"

#include <gtest/gtest.h>

namespace understudy {
namespace {

std::string error_of(const std::string& file, const InputError& thrown) {
  try {
    in_context_of(file, [&] { throw thrown; });
  } catch (const InputError& error) {
    EXPECT_EQ(message_without_place(error), message_without_place(thrown));
    return to_string(error.place()) + " | " + error.what();
  }
  return "nothing";
}

TEST(ErrorContext, GivesWhatTheWorkReturns) {
  EXPECT_EQ(in_context_of("a.csv", [] { return 3; }), 3);
}

TEST(ErrorContext, AnErrorWithoutAPlaceGetsTheFile) {
  EXPECT_EQ(error_of("a.csv", InputError("no points")), "a.csv | a.csv: no points");
}

TEST(ErrorContext, AnErrorKeepsThePlaceThatItHas) {
  EXPECT_EQ(error_of("a.csv", InputError(Place{"b.csv", 4, 2}, "no number")),
            "b.csv:4:2 | b.csv:4:2: no number");
}

TEST(ErrorContext, WithoutANameNothingIsAdded) {
  EXPECT_EQ(error_of("", InputError("no points")), " | no points");
}

}  // namespace
}  // namespace understudy
