// The pose that `register` writes is the one that a print reads.
#include "control/registration/part_pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/temporary_folder.h"

namespace understudy::control {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PartPose some_pose() {
  PartPose pose;
  pose.part = "a \"part\".stl";
  pose.part_sha256 = std::string(64, 'a');
  pose.machine = "hexapod";
  pose.machine_sha256 = std::string(64, 'b');
  pose.X_W = make_pose(Mat3(exp_rotation(Vec3(2e-3, -1e-3, 4e-3))), Vec3(0.3e-3, -0.2e-3, 0.1e-3));
  pose.reference_W = Vec3(1e-3, 2e-3, 30e-3);
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Zero();
  // 7 um and 0.2 mrad, and each freedom with a share of the one before.
  for (int k = 0; k < 6; ++k) root(k, k) = k < 3 ? 7e-6 : 0.2e-3;
  for (int k = 1; k < 6; ++k) root(k, k - 1) = 0.3 * root(k, k);
  pose.covariance = root * root.transpose();
  pose.unseen = {"turn about (0.00 1.00 0.00) through (0.0, 0.0, 15.5) mm"};
  return pose;
}

class PartPoseFile : public ::testing::Test {
 protected:
  PartPose read(const std::string& text) const {
    write_file(file_, text);
    return read_part_pose(file_);
  }
  std::string error_of(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  static std::string with(const std::string& old, const std::string& now) {
    std::string text = write_part_pose(some_pose(), "by hand");
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << text;
    return text.replace(at, old.size(), now);
  }
  const TemporaryFolder folder_;
  const std::string file_ = (folder_ / "pose.yaml").string();
};

TEST_F(PartPoseFile, ReadsBackWhatWasWritten) {
  const PartPose wrote = some_pose(), got = read(write_part_pose(wrote, "by hand"));
  EXPECT_EQ(got.part, wrote.part);
  EXPECT_EQ(got.part_sha256, wrote.part_sha256);
  EXPECT_EQ(got.machine, wrote.machine);
  EXPECT_EQ(got.machine_sha256, wrote.machine_sha256);
  EXPECT_EQ(got.unseen, wrote.unseen);
  // The file has nine decimals of a millimetre, twelve of a quaternion, ten digits of a covariance.
  EXPECT_TRUE(got.X_W.isApprox(wrote.X_W, 1e-9));
  EXPECT_TRUE(got.reference_W.isApprox(wrote.reference_W, 1e-9));
  EXPECT_TRUE(got.covariance.isApprox(wrote.covariance, 1e-9));
}

TEST_F(PartPoseFile, TheCommandIsACommentWhateverItsWords) {
  EXPECT_EQ(error_of(write_part_pose(some_pose(), "understudy register 'a\nunseen: [all]'")), "");
}

TEST_F(PartPoseFile, APoseByHandNeedsNoNames) {
  std::string text = write_part_pose(some_pose(), "by hand");
  text = text.substr(text.find("pose:"));
  EXPECT_EQ(read(text.substr(0, text.find("unseen"))).machine_sha256, "");
}

TEST_F(PartPoseFile, ACovarianceThatIsNoneIsRefused) {
  PartPose pose = some_pose();
  pose.covariance(1, 1) = -pose.covariance(1, 1);
  EXPECT_THAT(error_of(write_part_pose(pose, "by hand")),
              AllOf(HasSubstr("covariance_mm_rad"), HasSubstr("not positive"), HasSubstr("number 2")));
  pose = some_pose();
  pose.covariance(3, 2) = pose.covariance(2, 3) =
      1.1 * std::sqrt(pose.covariance(2, 2) * pose.covariance(3, 3));
  EXPECT_THAT(error_of(write_part_pose(pose, "by hand")), HasSubstr("not positive"));
}

TEST_F(PartPoseFile, AQuaternionThatIsNotUnitIsRefused) {
  EXPECT_THAT(error_of(with("part_quaternion: [0.99", "part_quaternion: [0.89")), HasSubstr("not 1"));
}

TEST_F(PartPoseFile, APartThatStandsElsewhereIsNotTheOneOfTheProgram) {
  PartPose pose = some_pose();
  pose.X_W.translation().x() += 25e-3;
  EXPECT_THAT(error_of(write_part_pose(pose, "by hand")), AllOf(HasSubstr("25."), HasSubstr("20 mm")));
  pose = some_pose();
  pose.X_W = make_pose(Mat3(exp_rotation(Vec3(0, 0, 30 * kDegree))), Vec3::Zero());
  pose.reference_W.setZero();
  EXPECT_THAT(error_of(write_part_pose(pose, "by hand")), AllOf(HasSubstr("30.00"), HasSubstr("20")));
}

TEST_F(PartPoseFile, AnotherUnitIsAnUnknownKey) {
  EXPECT_THAT(error_of(with("part_mm", "part_m")), AllOf(HasSubstr("part_m"), HasSubstr("part_mm")));
}

}  // namespace
}  // namespace understudy::control
