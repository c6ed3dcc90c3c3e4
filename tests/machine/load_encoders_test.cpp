#include "machine/load_encoders.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using testing::HasSubstr;

class LoadEncoderFile : public EditedFile {
 protected:
  const std::string hexapod_ = read_file(load_machine("hexapod").file.string());
  std::string with(const std::string& section) const { return hexapod_ + "\nload_encoders:\n" + section; }
};

TEST_F(LoadEncoderFile, CountsAreReadInTheirUnits) {
  const LoadEncoderCounts none = load_encoder_counts(write(hexapod_));
  EXPECT_EQ(none.of(false), 0);
  EXPECT_EQ(none.of(true), 0);
  const LoadEncoderCounts both = load_encoder_counts(write(with("  count_um: 0.5\n  count_arcmin: 0.6\n")));
  EXPECT_NEAR(both.of(false), 0.5e-6, 1e-18);
  EXPECT_NEAR(both.of(true), 0.01 * std::numbers::pi / 180, 1e-15);
}

TEST_F(LoadEncoderFile, CountsOutOfRangeAndOtherKeysAreRefused) {
  EXPECT_THAT(error_of(with("  count_um: 0\n")), HasSubstr("count_um"));
  EXPECT_THAT(error_of(with("  count_um: 2000\n")), HasSubstr("1000"));
  EXPECT_THAT(error_of(with("  count_arcmin: 61\n")), HasSubstr("60"));
  EXPECT_THAT(error_of(with("  count_mm: 1\n")), HasSubstr("count_mm"));
}

}  // namespace
}  // namespace understudy::machine
