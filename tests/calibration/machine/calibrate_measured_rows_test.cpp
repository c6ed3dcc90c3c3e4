// Tables of strangers, against a fit that shares nothing with ours: frames joint by joint, plain least
// squares.
#include "calibration/machine/calibrate_measured_rows.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/calibration/plain_lm.h"
#include "tests/calibration/rows/drawn_rows.h"
#include "tests/temporary_folder.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kData = UNDERSTUDY_SOURCE_DIR "/../shared/data";
constexpr double kQuarter = std::numbers::pi / 2;

using Table = std::vector<std::vector<double>>;

/// Rows of numbers; lines with words are passed over.
Table plain_table(std::string text, char separator) {
  if (separator == ';') std::replace(text.begin(), text.end(), ',', '.');
  std::replace(text.begin(), text.end(), separator, ' ');
  Table rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (double v = 0; cells >> v;) row.push_back(v);
    if (cells.eof() && !row.empty()) rows.push_back(row);
  }
  return rows;
}

/// One joint of a URDF, typed off it.
struct Joint {
  Vec3 xyz, rpy, axis;
};

/// Frames joint by joint, each moved by six numbers of its own: more than are needed.
Pose plain_forward(const std::vector<Joint>& joints, const Eigen::VectorXd& x, const double* q) {
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto at = 6 * static_cast<Eigen::Index>(i);
    X.translate(joints[i].xyz + x.segment<3>(at));
    X.rotate(Eigen::AngleAxisd(joints[i].rpy.z(), Vec3::UnitZ()) *
             Eigen::AngleAxisd(joints[i].rpy.y(), Vec3::UnitY()) *
             Eigen::AngleAxisd(joints[i].rpy.x(), Vec3::UnitX()));
    const Vec3 w = x.segment<3>(at + 3);
    if (w.norm() > 0) X.rotate(Eigen::AngleAxisd(w.norm(), w.normalized()));
    X.rotate(Eigen::AngleAxisd(q[i], joints[i].axis));
  }
  return X;
}

const std::vector<Joint> kUr10{
    {{0, 0, 0.1273}, {0, 0, 0}, {0, 0, 1}},      {{0, 0.220941, 0}, {0, kQuarter, 0}, {0, 1, 0}},
    {{0, -0.1719, 0.612}, {0, 0, 0}, {0, 1, 0}}, {{0, 0, 0.5723}, {0, kQuarter, 0}, {0, 1, 0}},
    {{0, 0.1149, 0}, {0, 0, 0}, {0, 0, 1}},      {{0, 0, 0.1157}, {0, 0, 0}, {0, 1, 0}}};
const std::vector<Joint> kPanda{{{0, 0, 0.333}, {0, 0, 0}, {0, 0, 1}},
                                {{0, 0, 0}, {-kQuarter, 0, 0}, {0, 0, 1}},
                                {{0, -0.316, 0}, {kQuarter, 0, 0}, {0, 0, 1}},
                                {{0.0825, 0, 0}, {kQuarter, 0, 0}, {0, 0, 1}},
                                {{-0.0825, 0.384, 0}, {-kQuarter, 0, 0}, {0, 0, 1}},
                                {{0, 0, 0}, {kQuarter, 0, 0}, {0, 0, 1}},
                                {{0.088, 0, 0}, {kQuarter, 0, 0}, {0, 0, 1}}};

/// A machine file around a stranger's URDF; returns its path.
std::string machine_around(const TemporaryFolder& folder, const fs::path& urdf, const std::string& base,
                           const std::string& tool,
                           const std::vector<std::pair<std::string, double>>& homes) {
  fs::copy_file(urdf, folder / "robot.urdf", fs::copy_options::overwrite_existing);
  std::string text = fmt::format(
      "name: stranger\nmechanism: chain\n"
      "geometry: {{urdf: robot.urdf, base_link: {}, tool_link: {}, tip_mm: [0, 0, 0], tool_direction: [0, 0, "
      "1], "
      "base_mm: [0, 0, 0], base_turn_deg: 0}}\nconditioning: {{length_scale_mm: 300, condition_max: "
      "500}}\naxes:\n",
      base, tool);
  for (const auto& [name, home] : homes)
    text += fmt::format(
        "  - {{name: {}, home_deg: {}, play_arcmin: 0.5, drive: {{lead_deg: 3.6, steps_per_turn: 8192, "
        "microsteps: 1, "
        "velocity_max_deg_per_s: 120, acceleration_max_deg_per_s2: 600}}, link: {{mass_kg: 2, centre_mm: [0, "
        "0, 0], "
        "inertia_kg_mm2: [20000, 20000, 20000]}}}}\n",
        name, home);
  text +=
      "tool:\n  nozzle_diameter_mm: 0.4\n  flat_diameter_mm: 1.0\n  filament_diameter_mm: 1.75\n  bodies:\n"
      "    - {name: nozzle, shape: frustum, bottom_centre_mm: [0, 0, 0], radius_bottom_mm: 0.5, "
      "radius_top_mm: 3.5, "
      "height_mm: 12}\n"
      "tolerances:\n"
      "  manufactured: {axis_position_mm: 0.2, axis_direction_deg: 0.02, zero_mm: 0, zero_deg: 0.05}\n"
      "  after_calibration: {axis_position_mm: 0.03, axis_direction_deg: 0.003, zero_mm: 0, zero_deg: "
      "0.003}\n"
      "gap: {accepted_min_mm: 0.10, accepted_max_mm: 0.20, aim_mm: 0.13, standoff_mm: 2}\n"
      "accuracy: {tip_mm: 0.2, orientation_deg: 2}\ntable: {size_mm: [200, 200, 10]}\n"
      "motion: {cycle_ms: 1, travel_mm_per_s: 75, orientation_deg_per_s: 60, acceleration_mm_per_s2: 500}\n";
  write_file(folder / "machine.yaml", text);
  return folder / "machine.yaml";
}

const char* const kTracker =
    "kind: pose\n"
    "joints: {columns: [shoulder_pan_joint, shoulder_lift_joint, elbow_joint, wrist_1_joint, wrist_2_joint, "
    "wrist_3_joint]}\n"
    "position: {columns: [measurement_x, measurement_y, measurement_z], unit: mm}\n"
    "orientation: {form: euler, columns: [measurement_rx, measurement_ry, measurement_rz], order: xyz, axes: "
    "moving, "
    "unit: deg}\nframe: tracker\ntarget: tmac\n";

class Tracker : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path file = kData / "measurements/ur10_laser_tracker/measurements_iso_cubes.csv";
    if (!fs::exists(file)) GTEST_SKIP() << "the folder shared/data is not beside the repository";
    std::istringstream in(read_file(file));
    std::getline(in, header_);
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
    request_.machine = machine_around(folder_, kData / "robots/ur10.urdf", "base_link", "tool0",
                                      {{"shoulder_pan_joint", 0},
                                       {"shoulder_lift_joint", -90},
                                       {"elbow_joint", 90},
                                       {"wrist_1_joint", -90},
                                       {"wrist_2_joint", -90},
                                       {"wrist_3_joint", 0}});
    map(kTracker);
  }

  void map(const std::string& text) {
    write_file(folder_ / "map.yaml", text);
    request_.map = read_column_map(folder_ / "map.yaml");
  }

  /// Lines k, k + 16, ... for the fit and the rest to compare.
  void split(std::size_t k) {
    std::string fitted = header_ + "\n", others = fitted;
    for (std::size_t j = 0; j < lines_.size(); ++j) (j % 16 == k ? fitted : others) += lines_[j] + "\n";
    write_file(folder_ / "fitted.csv", fitted);
    write_file(folder_ / "others.csv", others);
    request_.measurements = {folder_ / "fitted.csv"};
    request_.compared = {folder_ / "others.csv"};
  }

  std::string refused() const {
    try {
      (void)calibrate_measured_rows(request_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
  std::string header_;
  std::vector<std::string> lines_;
  RowsRequest request_;
};

TEST_F(Tracker, RowsThatWereHeldOutAreMetAsByAnIndependentFit) {
  split(1);
  const MachineCalibration ours = calibrate_measured_rows(request_);
  ASSERT_EQ(ours.compared.size(), 2u);
  const Table fitted = plain_table(read_file(folder_ / "fitted.csv"), ';'),
              others = plain_table(read_file(folder_ / "others.csv"), ';');
  // 36 numbers of the joints, 6 of the target, 6 of the tracker's frame, which begin where ours ended.
  const auto error = [](const Eigen::VectorXd& x, const std::vector<double>& row, const Mat3& R0,
                        const Mat3& G0) {
    const double deg = std::numbers::pi / 180;
    const Pose X = plain_forward(kUr10, x, row.data() + 7);
    const Mat3 F = exp_rotation(x.segment<3>(45)) * R0, G = G0 * exp_rotation(x.segment<3>(39));
    const Mat3 R =
        (Eigen::AngleAxisd(deg * row[20], Vec3::UnitX()) * Eigen::AngleAxisd(deg * row[22], Vec3::UnitY()) *
         Eigen::AngleAxisd(deg * row[24], Vec3::UnitZ()))
            .toRotationMatrix();
    Twist e;
    e.head<3>() =
        F * (X * Vec3(x.segment<3>(36))) + x.segment<3>(42) - 1e-3 * Vec3(row[14], row[16], row[18]);
    e.tail<3>() = log_rotation(R.transpose() * F * X.linear() * G);
    return e;
  };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(48);
  Vec3 turn_M, turn_G;
  for (const FoundNumber& f : ours.found)
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      if (f.name == "frame tracker " + axis) x[42 + k] = f.value;
      if (f.name == "frame tracker turn " + axis) turn_M[k] = f.value;
      if (f.name == "target tmac turn " + axis) turn_G[k] = f.value;
    }
  const Mat3 R0 = exp_rotation(turn_M);
  // Ours has its target on tool0, 92.2 mm along y of the last joint and turned.
  const Mat3 G0 = Mat3(Eigen::AngleAxisd(-kQuarter, Vec3::UnitX())) * exp_rotation(turn_G);
  const double length = ours.parts[0].added, turn = ours.parts[1].added;
  const auto all = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd e(6 * static_cast<Eigen::Index>(fitted.size()));
    for (std::size_t j = 0; j < fitted.size(); ++j) {
      const Twist one = error(at, fitted[j], R0, G0);
      e.segment<6>(6 * static_cast<Eigen::Index>(j)) << one.head<3>() / length, one.tail<3>() / turn;
    }
    return e;
  };
  x = plain_lm(all, x, 60);
  double squares = 0;
  for (const auto& row : others) squares += error(x, row, R0, G0).head<3>().squaredNorm();
  const double theirs = std::sqrt(squares / static_cast<double>(others.size()));
  EXPECT_NEAR(ours.compared[0].after, theirs, 0.01 * theirs);
  EXPECT_LT(ours.compared[0].after, 0.7 * ours.compared[0].before);
}

// Sixteen disjoint sets of 39 or 40 rows: the spread of what they find is what each states. 1 sigma of a
// spread of 16 is 18 %; the mean over the tracker's and the target's numbers that are told well is nearer.
TEST_F(Tracker, TheStatedSigmaIsTheSpreadOfRepeatedCalibrations) {
  constexpr std::size_t kSets = 16;
  std::vector<std::vector<double>> values, sigmas;
  for (std::size_t k = 0; k < kSets; ++k) {
    split(k);
    request_.compared.clear();
    const MachineCalibration found = calibrate_measured_rows(request_);
    values.emplace_back();
    sigmas.emplace_back();
    for (const ParameterLine& p : found.parameters) {
      values.back().push_back(p.after);
      sigmas.back().push_back(p.sigma);
    }
  }
  double log_ratio = 0;
  const std::size_t numbers = values.front().size();
  for (std::size_t i = 0; i < numbers; ++i) {
    double mean = 0, square = 0, stated = 0;
    for (std::size_t k = 0; k < kSets; ++k) {
      mean += values[k][i] / kSets;
      stated += sigmas[k][i] * sigmas[k][i] / kSets;
    }
    for (std::size_t k = 0; k < kSets; ++k) square += std::pow(values[k][i] - mean, 2) / (kSets - 1);
    log_ratio += 0.5 * std::log(square / stated) / static_cast<double>(numbers);
  }
  EXPECT_NEAR(std::exp(log_ratio), 1, 0.3);
}

TEST_F(Tracker, WrongUnitsAndConventionsAreNamed) {
  split(1);
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  map(edited(kTracker, "unit: mm", "unit: m"));
  EXPECT_THAT(refused(), HasSubstr("only if lengths are in mm"));
  map(edited(kTracker, "wrist_3_joint]", "wrist_3_joint], unit: deg"));
  EXPECT_THAT(refused(), HasSubstr("only if joints are radians"));
  map(edited(kTracker, "order: xyz, axes: moving", "order: zyx, axes: moving"));
  EXPECT_THAT(refused(), HasSubstr("order xyz, axes moving"));
  map(edited(kTracker, "wrist_2_joint, ", ""));
  EXPECT_THAT(refused(), HasSubstr("5 columns, machine stranger has 6 axes"));
  map(edited(kTracker, "elbow_joint, wrist_1_joint", "wrist_1_joint, elbow_joint"));
  EXPECT_THAT(refused(), HasSubstr("another machine, order of rows, zeros"));
}

TEST(Sockets, AreMetAsByAnIndependentFitOfTheConstraint) {
  const fs::path data = kData / "measurements/panda_sockets";
  if (!fs::exists(data)) GTEST_SKIP() << "the folder shared/data is not beside the repository";
  const TemporaryFolder folder;
  RowsRequest request;
  request.machine = machine_around(folder, data / "panda.urdf", "panda_link0", "ball_link",
                                   {{"panda_joint1", 0},
                                    {"panda_joint2", -30},
                                    {"panda_joint3", 0},
                                    {"panda_joint4", -120},
                                    {"panda_joint5", 0},
                                    {"panda_joint6", 90},
                                    {"panda_joint7", 45}});
  write_file(folder / "map.yaml",
             "kind: point\njoints: {columns: [1, 2, 3, 4, 5, 6, 7]}\ntarget: ball\n"
             "distances: [{between: [hole_0, hole_1], length_mm: 50, sigma_um: 10}]\n");
  request.map = read_column_map(folder / "map.yaml");
  request.measurements = {data / "front/hole_0.csv", data / "front/hole_1.csv"};
  const MachineCalibration ours = calibrate_measured_rows(request);
  ASSERT_EQ(ours.parts.size(), 1u);

  // 42 numbers of the joints, the ball, two sockets; a decimetre or radian of each joint is no hindrance.
  std::vector<Table> holes;
  for (const std::string& file : request.measurements) holes.push_back(plain_table(read_file(file), ','));
  const auto error = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd e(3 * static_cast<Eigen::Index>(holes[0].size() + holes[1].size()) + 1);
    Eigen::Index k = 0;
    for (std::size_t hole = 0; hole < 2; ++hole)
      for (const auto& q : holes[hole]) {
        e.segment<3>(k) = plain_forward(kPanda, x, q.data()) * Vec3(x.segment<3>(42)) -
                          x.segment<3>(45 + 3 * static_cast<Eigen::Index>(hole));
        k += 3;
      }
    e[k] = 20 * ((x.segment<3>(45) - x.segment<3>(48)).norm() - 0.05);  // 10 um beside 0.2 mm
    return e;
  };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(51);
  x[44] = 0.24;
  for (Eigen::Index hole = 0; hole < 2; ++hole)
    x.segment<3>(45 + 3 * hole) =
        plain_forward(kPanda, x, holes[static_cast<std::size_t>(hole)][0].data()) * Vec3(x.segment<3>(42));
  const Eigen::VectorXd left = error(plain_lm(error, x, 60));
  const double rms =
      std::sqrt(3 * left.head(left.size() - 1).squaredNorm() / static_cast<double>(left.size() - 1));
  EXPECT_NEAR(ours.parts[0].after, rms, 0.05 * rms);
  EXPECT_LT(ours.parts[0].after, 0.1 * ours.parts[0].before);
}

/// Rows of the shipped arm, with the columns of docs/calibration-data.md.
class PartialPoses : public ::testing::Test {
 protected:
  std::string table(bool position) {
    const machine::MachineDescription arm = machine::load_machine("arm");
    DrawnRows lab(DrawnRows::nominal_rows(arm).free_parameters(false, false), 5);
    std::string text = position ? "x_mm,y_mm,z_mm" : "qw,qx,qy,qz";
    for (int i = 1; i <= 6; ++i) text += fmt::format(",j{}_deg", i);
    text += "\n";
    for (int j = 0; j < 60; ++j) {
      const auto axes = lab.drawn_axes();
      const Pose X = arm.X_WB * lab.built.forward(axes);
      const Vec3 p = 1e3 * (X.translation() + lab.noise(kDrawnSigma));
      const Quat q(Mat3(exp_rotation(lab.noise(kDrawnTurn)) * X.linear()));
      text += position ? fmt::format("{},{},{}", p.x(), p.y(), p.z())
                       : fmt::format("{},{},{},{}", q.w(), q.x(), q.y(), q.z());
      for (const double a : axes) text += fmt::format(",{}", a * 180 / std::numbers::pi);
      text += "\n";
    }
    write_file(folder_ / "rows.csv", text);
    return folder_ / "rows.csv";
  }
  static std::optional<ColumnMap> map_of(const std::string& file) {
    return map_of_partial_poses(read_file(file), file, "arm");
  }
  TemporaryFolder folder_;
};

TEST_F(PartialPoses, AFileThatWasReadIsNotReadAgainButOthersAre) {
  RowsRequest request;
  request.machine = "arm";
  request.measurements = {table(true)};
  request.map = map_of(request.measurements.front()).value();
  std::filesystem::rename(folder_ / "rows.csv", folder_ / "others.csv");  // as a pipe that has been emptied
  request.compared = {folder_ / "others.csv"};
  EXPECT_EQ(calibrate_measured_rows(request).compared.size(), 1u);
  request.compared = {folder_ / "none.csv"};
  EXPECT_THROW(calibrate_measured_rows(request), InputError);
}

TEST_F(PartialPoses, PositionsWithoutOrientationCalibrate) {
  RowsRequest request;
  request.machine = "arm";
  request.measurements = {table(true)};
  const auto map = map_of(request.measurements.front());
  ASSERT_TRUE(map);
  request.map = *map;
  const MachineCalibration found = calibrate_measured_rows(request);
  ASSERT_EQ(found.parts.size(), 1u);
  EXPECT_NEAR(found.parts[0].added, kDrawnSigma, 0.25 * kDrawnSigma);
  EXPECT_TRUE(found.found.empty()) << "frame and target are the machine's own";
  EXPECT_LT(found.tip.rms, kDrawnSigma * 2);
}

TEST_F(PartialPoses, OrientationsAloneSayThatLengthsAreUntold) {
  RowsRequest request;
  request.machine = "arm";
  request.measurements = {table(false)};
  request.map = map_of(request.measurements.front()).value();
  const MachineCalibration found = calibrate_measured_rows(request);
  EXPECT_THAT(found.untold, ::testing::Contains(HasSubstr("shift")));
}

TEST_F(PartialPoses, WholePosesAreLeftToOtherEstimators) {
  write_file(folder_ / "p.csv", "# x\nx_mm,y_mm,z_mm,qw,qx,qy,qz,j1_deg\n");
  EXPECT_FALSE(map_of(folder_ / "p.csv"));
}

}  // namespace
}  // namespace understudy::calibration
