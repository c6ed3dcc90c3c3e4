// Tables of measured poses: what is read back, and what is refused with line and reason.
#include "calibration/machine/measurement_table.h"

#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>

#include "calibration/machine/calibrate_machine.h"
#include "calibration/machine/measurement_columns.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "tests/calibration/machine/measured_machine.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class MeasurementTable : public ::testing::Test {
 protected:
  void SetUp() override { sample_ = BuiltMachine(machine_, 1).measured(machine_, 12); }

  Measurements read(const std::string& text) const {
    write_file(path_, text);
    return read_measurements(path_.string(), machine_, kReferenceNoise);
  }
  std::string csv() const { return measurements_csv(sample_, machine_, "test"); }

  /// One line of refusal of the whole command; "accepted" where there is none.
  std::string refusal(const std::string& text, const std::string& estimator = "") const {
    write_file(path_, text);
    CalibrationRequest request;
    request.measurements = path_.string();
    request.machine = machine_.name;
    request.estimator = estimator;
    try {
      calibrate_machine(request);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what;
    }
    return "accepted";
  }
  template <typename Edit>
  std::string refused(Edit edit, const std::string& estimator = "") const {
    Measurements m = sample_;
    edit(m);
    return refusal(measurements_csv(m, machine_, "test"), estimator);
  }

  machine::MachineDescription machine_ = machine::load_machine("hexapod");
  Measurements sample_;
  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "table.csv";
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The third line is the first pose.
std::string with_cell(const std::string& text, std::size_t column, const std::string& value) {
  std::istringstream lines(text);
  std::string out, line;
  for (int count = 1; std::getline(lines, line); ++count) {
    if (count == 3) {
      std::size_t begin = 0;
      for (std::size_t i = 0; i < column; ++i) begin = line.find(',', begin) + 1;
      line.replace(begin, line.find(',', begin) - begin, value);
    }
    out += line + "\n";
  }
  return out;
}

TEST_F(MeasurementTable, ComesBackAsItWasWritten) {
  Measurements m = sample_;
  m.approach_told = true;
  m.frame = {6.5e-6, 0.07e-3, 0.03e-3};
  m.poses[2].approach[4] = Approach::shortening;
  Mat6 root = Mat6::Identity();
  root(3, 0) = 0.4;
  for (MeasuredPose& pose : m.poses) pose.covariance = (root * pose.covariance * root.transpose()).eval();
  const Measurements back = read(measurements_csv(m, machine_, "a comment 'of two\nlines'"));
  ASSERT_EQ(back.poses.size(), m.poses.size());
  EXPECT_TRUE(back.noise_given && back.approach_told);
  ASSERT_TRUE(back.frame);
  EXPECT_NEAR(back.frame->position, 6.5e-6, 1e-12);
  EXPECT_NEAR(back.frame->rotation, 0.07e-3, 1e-10);
  EXPECT_NEAR(back.frame->strain, 0.03e-3, 1e-10);
  for (std::size_t j = 0; j < m.poses.size(); ++j) {
    EXPECT_TRUE(back.poses[j].X_WT.isApprox(m.poses[j].X_WT, 2e-9));  // nine digits of the quaternion
    EXPECT_TRUE(back.poses[j].covariance.isApprox(m.poses[j].covariance, 1e-5));  // six digits
    EXPECT_EQ(back.poses[j].approach, m.poses[j].approach);
    EXPECT_EQ(back.poses[j].line, static_cast<int>(j) + 3);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back.poses[j].axes[i], m.poses[j].axes[i], 1e-9);
  }
}

TEST_F(MeasurementTable, MayHaveItsColumnsInAnyOrder) {
  const std::string text =
      "# by hand\nqw,qx,qy,qz,l6_mm,l5_mm,l4_mm,l3_mm,l2_mm,l1_mm,z_mm,y_mm,x_mm\n"
      "1,0,0,0,200.6,200.5,200.4,200.3,200.2,200.1,50,2,1\n";
  Measurements m = read(text);
  EXPECT_NEAR(m.poses[0].axes[0], 0.2001, 1e-12);
  EXPECT_TRUE(m.poses[0].X_WT.translation().isApprox(Vec3(1e-3, 2e-3, 50e-3), 1e-12));
  EXPECT_FALSE(m.noise_given);
  EXPECT_NEAR(m.poses[0].covariance(0, 0), 400e-12, 1e-18)
      << "20 um of docs/reference.md#calibration-figures";
}

TEST_F(MeasurementTable, ADevicesFrameIsTheSameInEveryRow) {
  Measurements m = sample_;
  m.frame = {6.5e-6, 0, 0};
  const std::string text = measurements_csv(m, machine_, "test");
  EXPECT_FALSE(read(csv()).frame);
  EXPECT_THAT(refusal(replaced(text, ",frame_permille", "")), HasSubstr("missing frame_permille"));
  const std::size_t column = 7 + 6 + 6;  // after pose, struts and noise
  EXPECT_THAT(refusal(with_cell(text, column, "-1")),
              AllOf(HasSubstr(".csv:3"), HasSubstr("frame_um is -1, below 0")));
  EXPECT_THAT(refusal(with_cell(text, column, "1e200")),
              AllOf(HasSubstr(".csv:3"), HasSubstr("more than 1 m")));
  EXPECT_THAT(refusal(with_cell(text, column, "7")), AllOf(HasSubstr(".csv:4"), HasSubstr("first row")));
}

TEST_F(MeasurementTable, NamesMissingAndUnknownColumns) {
  const std::string text = csv();
  EXPECT_THAT(refusal(replaced(text, ",l3_mm", "")),
              AllOf(HasSubstr(".csv:2"), HasSubstr("missing column l3_mm")));
  EXPECT_THAT(refusal(replaced(text, "x_mm", "x_m")),
              HasSubstr("unknown column 'x_m', did you mean 'x_mm'?"));
  EXPECT_THAT(refusal(replaced(text, "y_mm", "x_mm")), HasSubstr("'x_mm' is given twice"));
  EXPECT_THAT(refusal(replaced(text, ",sx_um", "")), HasSubstr("told in part: missing sx_um"));
  EXPECT_THAT(refusal(replaced(text, "l1_mm,l2_mm,l3_mm,l4_mm,l5_mm,l6_mm",
                               "j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg")),
              HasSubstr("unknown column 'j1_deg'"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal(text.substr(0, text.find('\n', 10) + 1)), HasSubstr("no poses"));
}

TEST_F(MeasurementTable, RefusesNumbersThatAreNone) {
  EXPECT_THAT(refusal(with_cell(csv(), 1, "nan")), AllOf(HasSubstr(".csv:3"), HasSubstr("y_mm is 'nan'")));
  EXPECT_THAT(refusal(with_cell(csv(), 2, "-1e12")),
              AllOf(HasSubstr(".csv:3"), HasSubstr("z_mm is -1e+12, beyond 100000")));
  EXPECT_THAT(refusal(with_cell(csv(), 8, "")), HasSubstr("l2_mm is ''"));
  EXPECT_THAT(refusal(with_cell(csv(), 3, "0.9")),
              AllOf(HasSubstr(".csv:3"), HasSubstr("quaternion's length")));
  EXPECT_THAT(refusal(with_cell(csv(), 13, "0")), HasSubstr("sx_um is 0, not in 1e-06..1e+06"));
  EXPECT_THAT(refusal(with_cell(csv(), 13, "1e-170")), HasSubstr("sx_um is 1e-170, not in"));
  EXPECT_THAT(refusal(with_cell(csv(), 13, "1e180")), HasSubstr("sx_um is 1e+180, not in 1e-06..1e+06"));
  EXPECT_THAT(refusal(csv() + "1,2,3\n"), HasSubstr("3 cells, not 19"));
}

TEST_F(MeasurementTable, RecognisesOtherUnitsBySize) {
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses) pose.X_WT.translation() *= 1e-3;
              }),
              HasSubstr("metres given for millimetres?"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses)
                  for (double& l : pose.axes) l *= 1e-3;
              }),
              AllOf(HasSubstr("l1_mm is 0."), HasSubstr("metres given for millimetres?")));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses)
                  for (double& l : pose.axes) l /= 25.4;
              }),
              HasSubstr("inches given for millimetres?"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses)
                  for (double& l : pose.axes) l -= 170e-3;
              }),
              HasSubstr("a displacement of the drive"));
}

TEST_F(MeasurementTable, RecognisesPosesOfAnotherFrameAndQuaternionsTheOtherWayRound) {
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses) pose.X_WT.translation().z() += 0.2;
              }),
              HasSubstr("another frame"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses) {
                  const Quat q(pose.X_WT.linear());
                  pose.X_WT.linear() = Quat(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
                }
              }),
              HasSubstr("x, y, z, w given for w, x, y, z?"));
}

TEST_F(MeasurementTable, SaysWhatTheMeasurementsLack) {
  EXPECT_THAT(refused([](Measurements& m) { m.poses.resize(6); }), HasSubstr("measure at least 7"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (std::size_t j = 6; j < m.poses.size(); ++j) m.poses[j] = m.poses[j - 6];
              }),
              HasSubstr("repeat"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses) pose.axes[2] = m.poses[0].axes[2];
              }),
              HasSubstr("strut 3"));
  EXPECT_THAT(refused([](Measurements&) {}, "with_play"), HasSubstr("needs the columns a1..a6"));
  EXPECT_THAT(refused([](Measurements&) {}, "maximum_likelyhood"), HasSubstr("did you mean"));
}

TEST_F(MeasurementTable, PosesWithoutRotationAreAnErrorWithAdvice) {
  const auto mechanism = machine_.make_mechanism();
  EXPECT_THAT(refused([&](Measurements& m) {
                for (auto& pose : m.poses) {
                  pose.X_WT.linear().setIdentity();
                  (void)mechanism->inverse(machine_.X_WB.inverse() * pose.X_WT, {}, pose.axes);
                }
              }),
              AllOf(HasSubstr("4 of the 7"), HasSubstr("tilt the platform")));
}

class ArmTable : public MeasurementTable {
 protected:
  void SetUp() override {
    machine_ = machine::load_machine("arm");
    MeasurementTable::SetUp();
  }
};

TEST_F(ArmTable, RefusesRadiansAndAxesThatStandStill) {
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses)
                  for (double& q : pose.axes) q *= kDegree;
              }),
              HasSubstr("radians given for degrees?"));
  EXPECT_THAT(refused([](Measurements& m) {
                for (auto& pose : m.poses) pose.axes[5] = m.poses[0].axes[5];
              }),
              HasSubstr("axis j6 never moves"));
  EXPECT_THAT(refused([](Measurements&) {}, "whitened"), HasSubstr("maximum_likelihood and robust"));
}

}  // namespace
}  // namespace understudy::calibration
