// What a machine file keeps of a calibration: comes back as it was written, and is refused where it is none.
#include "machine/calibrated_parameters.h"

#include "core/file/read_file.h"
#include "core/random.h"
#include "core/units.h"
#include "machine/file/calibration_section.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Half of the last of ten digits.
constexpr double kDigits = 5e-10;

MachineDescription calibrated(const char* name) {
  MachineDescription m = load_machine(name);
  if (m.is_chain()) m.chain().kinematics.design = m.chain().kinematics.chain;
  m.calibration = {"maximum_likelihood", "poses.csv", std::string(64, '0'), 24, 17.5e-6};
  return m;
}

/// Of rank 20, less than any machine has numbers.
Eigen::MatrixXd some_covariance(const MachineDescription& machine, bool with_play) {
  Random random(6, "covariance");
  Eigen::MatrixXd root(calibrated_units(machine, with_play).size(), 20);
  for (double& value : root.reshaped()) value = 20e-6 * random.normal();
  return root * root.transpose();
}

class CalibratedParametersFile : public EditedFile {
 protected:
  CalibratedParameters back(const MachineDescription& machine, const CalibratedParameters& parameters) const {
    const auto path = folder_ / "calibrated.yaml";
    write_calibrated(machine, path, parameters);
    CalibratedParameters read;
    (void)load_machine(path.string(), read);
    return read;
  }
  static void expect_same(const Eigen::MatrixXd& read, const Eigen::MatrixXd& written) {
    ASSERT_EQ(read.rows(), written.rows());
    const Eigen::VectorXd sigma = written.diagonal().cwiseSqrt();
    const Eigen::MatrixXd scale = sigma * sigma.transpose();
    EXPECT_LT((read - written).cwiseAbs().cwiseQuotient(scale).maxCoeff(), kDigits);
    EXPECT_EQ(read, read.transpose());
  }
};

TEST_F(CalibratedParametersFile, AHexapodsCovarianceComesBack) {
  const MachineDescription m = calibrated("hexapod");
  const CalibratedParameters written{{}, some_covariance(m, false)};
  EXPECT_EQ(written.covariance.rows(), 6 * 7 + 1) << "b_i, a_i, l_i0 and dev";
  const CalibratedParameters read = back(m, written);
  expect_same(read.covariance, written.covariance);
  EXPECT_FALSE(read.play);
}

TEST_F(CalibratedParametersFile, PlayComesBackWithItsCovariance) {
  const MachineDescription m = calibrated("hexapod");
  const CalibratedParameters written{{{50e-6, 61e-6, -2e-6, 40e-6, 0, 75.25e-6}}, some_covariance(m, true)};
  EXPECT_EQ(written.covariance.rows(), 49);
  const CalibratedParameters read = back(m, written);
  expect_same(read.covariance, written.covariance);
  ASSERT_TRUE(read.play);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    EXPECT_NEAR((*read.play)[i], (*written.play)[i], 1e-12);
}

TEST_F(CalibratedParametersFile, LeadsComeBackWithTheirCovariance) {
  const MachineDescription m = calibrated("hexapod");
  CalibratedParameters written;
  written.play.emplace().fill(80e-6);
  written.lead = {0.2e-3, -0.17e-3, 0, 0.31e-3, -0.28e-3, 1e-3};
  written.covariance = Eigen::VectorXd::LinSpaced(55, 1e-12, 55e-12).asDiagonal();
  const CalibratedParameters read = back(m, written);
  expect_same(read.covariance, written.covariance);
  ASSERT_TRUE(read.lead);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    EXPECT_NEAR((*read.lead)[i], (*written.lead)[i], 1e-9);
}

TEST_F(CalibratedParametersFile, AnArmsCovarianceComesBack) {
  const MachineDescription m = calibrated("arm");
  const CalibratedParameters written{{}, some_covariance(m, false)};
  EXPECT_EQ(written.covariance.rows(), 6 + 6 + 6 * 6) << "tool, work, and a line for each axis";
  expect_same(back(m, written).covariance, written.covariance);
}

TEST_F(CalibratedParametersFile, WhatIsNotToldIsEmpty) {
  CalibratedParameters read{{{1, 1, 1, 1, 1, 1}}, Eigen::MatrixXd::Identity(2, 2)};
  (void)load_machine("hexapod", read);
  EXPECT_FALSE(read.play);
  EXPECT_EQ(read.covariance.size(), 0);
  EXPECT_EQ(back(calibrated("hexapod"), {}).covariance.size(), 0);
}

TEST_F(CalibratedParametersFile, WhatIsNoCovarianceIsRefusedWithItsLine) {
  const MachineDescription m = calibrated("hexapod");
  Eigen::MatrixXd diagonal = Eigen::MatrixXd::Identity(43, 43) * 1e-10;  // (0.01 mm)^2 = 1e-4 mm^2
  const std::string text =
      with_section(read_file(m.file), calibration_section(m, CalibratedParameters{{}, diagonal}));
  const std::string key = "covariance_mm_rad";
  const auto first_rows = [&](const std::string& from, const std::string& to) {
    return error_of(edited(text, key, from, to));
  };
  EXPECT_THAT(first_rows("    0.0001,\n    0, 0.0001,", "    -0.0001,\n    0, 0.0001,"),
              AllOf(HasSubstr("calibration.covariance_mm_rad is not positive semi-definite"),
                    HasSubstr("the variance of number 1 is -"), HasSubstr("understudy calibrate")));
  // A correlation of 2: eigenvalues 1 + 2 and 1 - 2.
  EXPECT_THAT(first_rows("    0.0001,\n    0, 0.0001,", "    0.0001,\n    0.0002, 0.0001,"),
              HasSubstr("an eigenvalue of its correlations is -1"));
  EXPECT_THAT(first_rows("    0.0001,\n    0, 0.0001,", "    0.0001,\n    0.0001, 0,"),
              HasSubstr("the variance of number 2 is 0, its covariances are not"));
  EXPECT_THAT(first_rows("    0.0001,\n", ""), HasSubstr("a list of 945, where a list of 946 numbers"));
  EXPECT_THAT(first_rows("    0.0001,\n", "    .nan,\n"), HasSubstr("not finite"));
  // A correlation of 1 is allowed.
  EXPECT_THAT(first_rows("    0.0001,\n    0, 0.0001,", "    0.0001,\n    0.0001, 0.0001,"), "accepted");
}

}  // namespace
}  // namespace understudy::machine
