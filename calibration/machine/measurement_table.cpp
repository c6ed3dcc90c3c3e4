#include "calibration/machine/measurement_table.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/machine/measurement_columns.h"
#include "calibration/machine/plausibility.h"
#include "calibration/noise_bounds.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using Words = std::vector<std::string>;

constexpr double kUnitTolerance = 1e-4;  // of a quaternion, as in G-code
constexpr double kFarthest = 100;        // [m], of a tip, as in G-code

/// Words of the first line that is neither empty nor a comment.
struct Header {
  Words words;
  int line = 0;
};

Header header_of(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  std::string line;
  for (int count = 1; std::getline(in, line); ++count) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    if (line.empty() || line.front() == '#') continue;
    Header header{{}, count};
    std::istringstream cells(line);
    for (std::string word; std::getline(cells, word, ',');) header.words.push_back(word);
    if (line.back() == ',') header.words.emplace_back();
    return header;
  }
  throw InputError({file, 0, 0}, "is empty; its first line names the columns (docs/calibration-data.md)");
}

/// One row by the names of its columns.
class Row {
 public:
  Row(const std::string& file, const Words& header, const NumberRow& row) : place_{file, row.line, 0} {
    for (std::size_t i = 0; i < header.size(); ++i) values_[header[i]] = row.values[i];
  }
  double at(const std::string& column) const { return values_.at(column); }
  const Place& place() const { return place_; }

 private:
  Place place_;
  std::map<std::string, double> values_;
};

Pose pose_of(const Row& row) {
  const Quat q(row.at("qw"), row.at("qx"), row.at("qy"), row.at("qz"));
  if (std::abs(q.norm() - 1) > kUnitTolerance)
    throw InputError(row.place(), fmt::format("the quaternion's length is {:.6f}, not 1 within {:g}",
                                              q.norm(), kUnitTolerance));
  for (const char* column : {"x_mm", "y_mm", "z_mm"})
    if (!(std::abs(row.at(column)) <= to_mm(kFarthest)))
      throw InputError(row.place(),
                       fmt::format("{} is {:g}, beyond {:g}", column, row.at(column), to_mm(kFarthest)));
  return make_pose(q.normalized(), from_mm(1) * Vec3(row.at("x_mm"), row.at("y_mm"), row.at("z_mm")));
}

Mat6 covariance_of(const Row& row, NoiseColumns kind, const Mat6& assumed) {
  if (kind == NoiseColumns::none) return assumed;
  const Words& columns = noise_columns(kind);
  Mat6 covariance = Mat6::Zero();
  if (kind == NoiseColumns::full) {
    std::size_t next = 0;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = i; j < 6; ++j, ++next)
        covariance(i, j) = covariance(j, i) = row.at(columns[next]) * noise_unit(columns[next]);
    if (!(covariance.cwiseAbs().maxCoeff() <= kLargestNoise * kLargestNoise))
      throw InputError(row.place(),
                       fmt::format("the covariance c11..c66 holds {:g}, at most {:g} m^2 or rad^2",
                                   covariance.cwiseAbs().maxCoeff(), kLargestNoise * kLargestNoise));
    if (covariance.llt().info() != Eigen::Success)
      throw InputError(row.place(), "the covariance c11..c66 is not positive definite");
    return covariance;
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    const std::string& column = columns[static_cast<std::size_t>(kind == NoiseColumns::axes ? i : i / 3)];
    const double sigma = row.at(column) * noise_unit(column);
    if (!(sigma >= kLeastNoise && sigma <= kLargestNoise))
      throw InputError(row.place(),
                       fmt::format("{} is {:g}, not in {:g}..{:g}", column, row.at(column),
                                   kLeastNoise / noise_unit(column), kLargestNoise / noise_unit(column)));
    covariance(i, i) = sigma * sigma;
  }
  return covariance;
}

kinematics::PerStrut<Approach> approach_of(const Row& row) {
  kinematics::PerStrut<Approach> approach{};
  for (std::size_t i = 0; i < approach.size(); ++i) {
    const std::string& column = approach_columns()[i];
    const double side = row.at(column);
    if (side != -1 && side != 0 && side != 1)
      throw InputError(
          row.place(),
          fmt::format("{} is {:g}: 1 came by lengthening, -1 by shortening, 0 unknown", column, side));
    approach[i] = static_cast<Approach>(static_cast<int>(side));
  }
  return approach;
}

/// The device's frame by one row; the rows before must have told the same.
void read_frame(const Row& row, std::optional<MeasuringFrame>& frame) {
  constexpr double kPerMille = 1e-3;
  for (const std::string& column : frame_columns())
    if (!(row.at(column) >= 0))
      throw InputError(row.place(), fmt::format("{} is {:g}, below 0", column, row.at(column)));
  const MeasuringFrame here{kMicrometre * row.at("frame_um"), 1e-3 * row.at("frame_mrad"),
                            kPerMille * row.at("frame_permille")};
  if (!(std::max({here.position, here.rotation, here.strain}) <= kLargestNoise))
    throw InputError(
        row.place(),
        fmt::format("frame_um, frame_mrad or frame_permille is more than {:g} m, {:g} rad or 1000 permille",
                    kLargestNoise, kLargestNoise));
  if (frame && !(*frame == here))
    throw InputError(row.place(),
                     "frame_um, frame_mrad and frame_permille are not those of the first row: the device's "
                     "frame errs alike in all poses");
  frame = here;
}

std::vector<double> axes_of(const Row& row, const Words& columns) {
  std::vector<double> axes;
  for (const std::string& column : columns)
    axes.push_back(row.at(column) * (column.ends_with("_deg") ? kDegree : kMillimetre));
  return axes;
}

NoiseColumns kind_of(const Measurements& measurements) {
  if (!measurements.noise_given) return NoiseColumns::none;
  for (const MeasuredPose& pose : measurements.poses) {
    const Mat6 diagonal = pose.covariance.diagonal().asDiagonal();
    if (pose.covariance != diagonal) return NoiseColumns::full;
  }
  return NoiseColumns::axes;
}

void append_noise(const Mat6& covariance, NoiseColumns kind, Words& cells) {
  const Words& columns = noise_columns(kind);
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = i; j < (kind == NoiseColumns::full ? 6 : i + 1); ++j, ++next) {
      const double value = kind == NoiseColumns::full ? covariance(i, j) : std::sqrt(covariance(i, i));
      cells.push_back(fmt::format("{:.6g}", value / noise_unit(columns[next])));
    }
}

}  // namespace

Mat6 told_in(const Mat3& R_WB, const Mat6& covariance_B) {
  Mat6 both = Mat6::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R_WB;
  return both * covariance_B * both.transpose();
}

Measurements read_measurements(const std::string& file, const machine::MachineDescription& machine,
                               const MeasurementNoise& assumed) {
  return parse_measurements(read_file(file), file, machine, assumed);
}

Measurements parse_measurements(const std::string& text, const std::string& file,
                                const machine::MachineDescription& machine, const MeasurementNoise& assumed) {
  const Header header = header_of(text, file);
  const TableColumns columns = check_columns(header.words, machine, file, header.line);
  std::istringstream in(text);
  Measurements result;
  result.file = file;
  result.sha256 = sha256_hex(text);
  result.noise_given = columns.noise != NoiseColumns::none;
  result.approach_told = columns.approach;
  const Words axes = axis_columns(machine);
  for (const NumberRow& numbers : read_number_table(in, file, header.words)) {
    const Row row(file, header.words, numbers);
    MeasuredPose pose;
    pose.line = numbers.line;
    pose.X_WT = pose_of(row);
    pose.covariance = covariance_of(row, columns.noise, assumed.covariance());
    pose.axes = axes_of(row, axes);
    if (columns.approach) pose.approach = approach_of(row);
    if (columns.frame) read_frame(row, result.frame);
    result.poses.push_back(std::move(pose));
  }
  if (result.poses.empty()) throw InputError({file, 0, 0}, "has a header but no poses");
  check_plausible(result, machine);
  return result;
}

std::string measurements_csv(const Measurements& measurements, const machine::MachineDescription& machine,
                             const std::string& comment) {
  const NoiseColumns noise = kind_of(measurements);
  const Words axes = axis_columns(machine);
  Words header = pose_columns();
  for (const Words* more : {&axes, &noise_columns(noise)})
    header.insert(header.end(), more->begin(), more->end());
  if (measurements.approach_told)
    header.insert(header.end(), approach_columns().begin(), approach_columns().end());
  if (measurements.frame) header.insert(header.end(), frame_columns().begin(), frame_columns().end());
  std::string out = fmt::format("# {}\n{}\n", printable(comment, std::string::npos), fmt::join(header, ","));
  for (const MeasuredPose& pose : measurements.poses) {
    Quat q(pose.X_WT.linear());
    if (q.w() < 0) q.coeffs() *= -1;
    const Vec3 p = 1e3 * pose.X_WT.translation();
    Words cells;
    for (const double v : {p.x(), p.y(), p.z()}) cells.push_back(fmt::format("{:.6f}", v));
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) cells.push_back(fmt::format("{:.9f}", v));
    for (std::size_t i = 0; i < axes.size(); ++i)
      cells.push_back(
          fmt::format("{:.6f}", pose.axes[i] / (axes[i].ends_with("_deg") ? kDegree : kMillimetre)));
    if (noise != NoiseColumns::none) append_noise(pose.covariance, noise, cells);
    for (std::size_t i = 0; measurements.approach_told && i < kinematics::kStruts; ++i)
      cells.push_back(std::to_string(static_cast<int>(pose.approach[i])));
    if (const auto& frame = measurements.frame)
      for (const double v : {to_um(frame->position), 1e3 * frame->rotation, 1e3 * frame->strain})
        cells.push_back(fmt::format("{:.4g}", v));
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

Problem hexapod_problem(const Measurements& measurements, const machine::MachineDescription& machine) {
  Problem problem{{machine.hexapod().geometry, {}}, {}};
  const Pose X_BW = machine.X_WB.inverse();
  for (const MeasuredPose& pose : measurements.poses) {
    PoseSample sample;
    sample.X_BT = X_BW * pose.X_WT;
    sample.covariance = told_in(X_BW.linear(), pose.covariance);
    kinematics::StrutLengths lengths{};
    std::copy_n(pose.axes.begin(), lengths.size(), lengths.begin());
    sample.displacement = displacements(machine.hexapod().geometry, lengths);
    sample.approach = pose.approach;
    problem.samples.push_back(sample);
  }
  return problem;
}

std::vector<ChainSample> chain_samples(const Measurements& measurements,
                                       const machine::MachineDescription& machine) {
  std::vector<ChainSample> samples;
  const Pose X_BW = machine.X_WB.inverse();
  for (const MeasuredPose& pose : measurements.poses)
    samples.push_back({pose.axes, X_BW * pose.X_WT, told_in(X_BW.linear(), pose.covariance)});
  return samples;
}

}  // namespace understudy::calibration
