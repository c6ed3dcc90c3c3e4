#include "machine/accepted_errors.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::machine {
namespace {

class AcceptedErrorsOf : public testing::Test {
 protected:
  /// The shipped hexapod, with another section `accuracy`.
  AcceptedErrors file_with(const std::string& section) {
    std::string yaml = read_file(models_folder() / "hexapod" / "machine.yaml");
    const std::size_t begin = yaml.find("\naccuracy:\n") + 1, end = yaml.find("\ntable:\n");
    yaml.replace(begin, end - begin, section);
    std::ofstream(path_) << yaml;
    return load_accepted_errors(path_.string());
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "machine.yaml";
};

// Song 2015 asks for 0.5 mm of a calibrated machine.
TEST_F(AcceptedErrorsOf, AShippedMachineAreThoseOfItsFile) {
  const AcceptedErrors errors = load_accepted_errors("hexapod");
  EXPECT_NEAR(errors.tip, 0.5e-3, 1e-12);
  EXPECT_NEAR(errors.orientation, from_deg(2), 1e-12);
}

TEST_F(AcceptedErrorsOf, AFileThatDoesNotSayAreABoreAndFiveDegrees) {
  const AcceptedErrors errors = file_with("");
  EXPECT_NEAR(errors.tip, 0.4e-3, 1e-12);
  EXPECT_NEAR(errors.orientation, from_deg(5), 1e-12);
}

TEST_F(AcceptedErrorsOf, ASectionIsReadStrictly) {
  EXPECT_NEAR(file_with("accuracy: {tip_mm: 0.3, orientation_deg: 1}\n").tip, 0.3e-3, 1e-12);
  const auto refusal = [&](const std::string& section) -> std::string {
    try {
      file_with(section);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal("accuracy: {tip_um: 300, orientation_deg: 1}\n"), testing::HasSubstr("tip_um"));
  EXPECT_THAT(refusal("accuracy: {tip_mm: 0.3}\n"), testing::HasSubstr("orientation_deg"));
  EXPECT_THAT(refusal("accuracy: {tip_mm: 0, orientation_deg: 1}\n"), testing::HasSubstr("tip_mm"));
}

}  // namespace
}  // namespace understudy::machine
