#include "calibration/table/raw_table.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "calibration/table/header_units.h"
#include "core/error.h"
#include "core/file/read_file.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr double kOffRotation = 1e-3;  // of a quaternion's length, of a matrix' entries: digits of an export

std::vector<std::vector<double>> numbers(const DelimitedText& text, const std::vector<std::string>& names) {
  std::vector<std::size_t> columns;
  for (const std::string& name : names) columns.push_back(text.column(name));
  std::vector<std::vector<double>> rows(text.rows());
  for (std::size_t j = 0; j < text.rows(); ++j)
    for (const std::size_t column : columns) rows[j].push_back(text.number(j, column));
  return rows;
}

std::vector<std::string> names(const DelimitedText& text, const std::string& column, const std::string& all) {
  std::vector<std::string> words(text.rows(), all);
  if (column.empty()) return words;
  const std::size_t at = text.column(column);
  for (std::size_t j = 0; j < text.rows(); ++j) words[j] = text.text(j, at);
  return words;
}

/// Squares of 1 sigma on three axes.
Vec3 variances(const std::vector<double>& told, double unit, double all) {
  if (told.empty()) return Vec3::Constant(all * all);
  Vec3 v;
  for (Eigen::Index k = 0; k < 3; ++k)
    v[k] = std::pow(unit * told[told.size() == 3 ? static_cast<std::size_t>(k) : 0], 2);
  return v;
}

class RowMaker {
 public:
  RowMaker(const RawTable& raw, const machine::MachineDescription& machine)
      : raw_(raw), axes_(row_axes(machine)), X_BW_(machine.X_WB.inverse()) {}

  MeasurementRow row(std::size_t j) const {
    const TableMap& map = raw_.map;
    MeasurementRow row;
    row.kind = map.kind;
    row.table = raw_.index;
    row.line = raw_.lines[j];
    row.frame = map.frame;
    row.target = raw_.targets[j] == "tool" ? "" : raw_.targets[j];
    row.place = raw_.ids[j];
    for (std::size_t i = 0; i < raw_.joints[j].size(); ++i)
      row.axes.push_back(raw_.joints[j][i] * (axes_[i].angle ? map.joints.unit : map.slide_unit));
    measured(j, row);
    noise(j, row);
    return row;
  }

 private:
  void measured(std::size_t j, MeasurementRow& row) const {
    const TableMap& map = raw_.map;
    if (map.distance) row.distance = map.distance->unit * raw_.distance[j];
    Vec3 p = Vec3::Zero();
    Mat3 R = Mat3::Identity();
    if (map.position)
      p = map.position->unit * Vec3(raw_.position[j][0], raw_.position[j][1], raw_.position[j][2]);
    if (map.orientation) {
      const double off = off_rotation(map.reading, raw_.orientation[j]);
      if (off > kOffRotation)
        throw InputError({raw_.file, row.line, 0}, fmt::format("{}: off a rotation by {:.2g}, more than {:g}",
                                                               to_string(map.reading), off, kOffRotation));
      R = orientation_of(map.reading, raw_.orientation[j]);
    }
    row.X_MG = make_pose(R, p);
    if (map.frame.empty()) row.X_MG = X_BW_ * row.X_MG;
  }

  void noise(std::size_t j, MeasurementRow& row) const {
    const TableMap& map = raw_.map;
    const bool turns = map.orientation.has_value(), lengths = !turns || map.position.has_value();
    const auto sigma_unit = [](const std::optional<NumberColumns>& numbers) {
      return numbers ? numbers->sigma_unit / numbers->sigma_coverage : 1;
    };
    const double unit = sigma_unit(map.position ? map.position : map.distance);
    const auto none = std::vector<double>();
    row.covariance.diagonal().head<3>() =
        variances(raw_.sigma_position.empty() ? none : raw_.sigma_position[j], unit, map.sigma_position);
    row.covariance.diagonal().tail<3>() = variances(raw_.sigma_turn.empty() ? none : raw_.sigma_turn[j],
                                                    sigma_unit(map.orientation), map.sigma_turn);
    const auto diagonal = row.covariance.diagonal();
    row.noise_told =
        (!lengths || diagonal.head<3>().minCoeff() > 0) && (!turns || diagonal.tail<3>().minCoeff() > 0);
    if (!row.noise_told) row.covariance.setZero();
  }

  const RawTable& raw_;
  std::vector<RowAxis> axes_;
  Pose X_BW_;
};

}  // namespace

RawTable read_raw(const TableMap& map, const std::string& file, const fs::path& joint_file,
                  std::string& bytes) {
  RawTable raw;
  raw.map = map;
  raw.file = file;
  const std::string content = map.read && map.read->file == file ? map.read->text : read_file(file);
  bytes += content;
  const DelimitedText text(content, file, map.format);
  for (std::size_t j = 0; j < text.rows(); ++j) raw.lines.push_back(text.line(j));
  std::optional<DelimitedText> log;
  if (!map.joint_file.empty()) {
    const std::string written = read_file(joint_file);
    bytes += written;
    log.emplace(written, joint_file.string(), map.joint_format);
    if (log->rows() != text.rows())
      throw InputError({file, 0, 0}, fmt::format("has {} rows, {} has {}: rows are joined by their number",
                                                 text.rows(), joint_file.string(), log->rows()));
  }
  const DelimitedText& joints = log ? *log : text;
  settle_units(text, joints, raw.map);
  raw.joints = numbers(joints, map.joints.columns);
  if (map.position) {
    raw.position = numbers(text, map.position->columns);
    raw.sigma_position = numbers(text, map.position->sigma);
  }
  if (map.orientation) {
    raw.orientation = numbers(text, map.orientation->columns);
    raw.sigma_turn = numbers(text, map.orientation->sigma);
  }
  if (map.distance) {
    for (const auto& row : numbers(text, map.distance->columns)) raw.distance.push_back(row[0]);
    raw.sigma_position = numbers(text, map.distance->sigma);
  }
  raw.targets = names(text, map.target_column, map.target);
  raw.ids = names(text, map.id_column, map.id.empty() ? fs::path(file).stem().string() : map.id);
  return raw;
}

std::vector<MeasurementRow> rows_of(const RawTable& raw, const machine::MachineDescription& machine) {
  const RowMaker maker(raw, machine);
  std::vector<MeasurementRow> rows;
  for (std::size_t j = 0; j < raw.lines.size(); ++j) rows.push_back(maker.row(j));
  return rows;
}

std::vector<RowAxis> row_axes(const machine::MachineDescription& machine) {
  std::vector<RowAxis> axes;
  if (machine.is_chain()) {
    for (const auto& axis : machine.chain().kinematics.chain.axes)
      axes.push_back({axis.name, axis.angle, axis.lower, axis.upper});
  } else {
    const auto& limits = machine.hexapod().limits;
    for (std::size_t i = 1; i <= kStruts; ++i)
      axes.push_back({fmt::format("l{}", i), false, limits.strut_min, limits.strut_max});
  }
  return axes;
}

}  // namespace understudy::calibration
