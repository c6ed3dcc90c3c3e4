#include "calibration/table/raw_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "calibration/noise_bounds.h"
#include "calibration/table/header_units.h"
#include "core/cross_matrix.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/some_of.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kOffRotation = 1e-3;  // of a quaternion's length, of a matrix' entries: digits of an export

using Numbers = std::vector<std::vector<double>>;

/// With `may_be_missing`, NaN stands for an empty cell and for one that says that nothing was measured.
Numbers numbers(const DelimitedText& text, const std::vector<std::string>& names, bool may_be_missing) {
  std::vector<std::size_t> columns;
  for (const std::string& name : names) columns.push_back(text.column(name));
  Numbers rows(text.rows());
  for (std::size_t j = 0; j < text.rows(); ++j)
    for (const std::size_t column : columns)
      rows[j].push_back(may_be_missing && text.is_missing(j, column) ? kMissing : text.number(j, column));
  return rows;
}

bool any_missing(const Numbers& numbers, std::size_t row) {
  return !numbers.empty() &&
         std::any_of(numbers[row].begin(), numbers[row].end(), [](double v) { return std::isnan(v); });
}

constexpr std::size_t kNamed = 6;  // lines in a note

std::vector<std::string> texts(const std::vector<int>& lines) {
  std::vector<std::string> list;
  for (const int line : lines) list.push_back(fmt::to_string(line));
  return list;
}

void leave_out_missing(RawTable& raw) {
  std::vector<bool> kept;
  std::vector<int> left_out;
  for (std::size_t j = 0; j < raw.lines.size(); ++j) {
    bool missing = !raw.distance.empty() && std::isnan(raw.distance[j]);
    for (const Numbers* all : {&raw.position, &raw.orientation, &raw.sigma_position, &raw.sigma_turn})
      missing = missing || any_missing(*all, j);
    kept.push_back(!missing);
    if (missing) left_out.push_back(raw.lines[j]);
  }
  if (left_out.empty()) return;
  if (left_out.size() == raw.lines.size())
    throw InputError({raw.file, left_out.front(), 0}, "no row has all of its measured numbers");
  const auto keep = [&kept](auto& list) {
    if (list.empty()) return;
    std::size_t to = 0;
    for (std::size_t j = 0; j < kept.size(); ++j)
      if (kept[j]) std::swap(list[to++], list[j]);
    list.resize(to);
  };
  for (Numbers* all : {&raw.joints, &raw.position, &raw.orientation, &raw.sigma_position, &raw.sigma_turn})
    keep(*all);
  keep(raw.distance);
  keep(raw.lines);
  keep(raw.targets);
  keep(raw.ids);
  raw.notes.push_back(fmt::format("{}: {} rows without a measurement were left out: lines {}", raw.file,
                                  left_out.size(), some_of(texts(left_out), kNamed)));
}

/// A device that rounds its sigmas may write 0, which would weigh without end.
void settle_sigmas(Numbers& sigmas, RawTable& raw) {
  if (sigmas.empty() || sigmas.front().empty()) return;
  double least = std::numeric_limits<double>::infinity();
  std::vector<int> none;
  for (std::size_t j = 0; j < sigmas.size(); ++j) {
    for (const double sigma : sigmas[j]) {
      if (sigma < 0)
        throw InputError({raw.file, raw.lines[j], 0},
                         fmt::format("a sigma is {}: it cannot be negative", sigma));
      if (sigma > 0) least = std::min(least, sigma);
    }
    if (std::find(sigmas[j].begin(), sigmas[j].end(), 0.0) != sigmas[j].end()) none.push_back(raw.lines[j]);
  }
  if (none.empty() || !std::isfinite(least)) return;
  for (auto& row : sigmas) std::replace(row.begin(), row.end(), 0.0, least);
  raw.notes.push_back(fmt::format("{}: sigmas of 0 are taken as {:g}, the least of the others: lines {}",
                                  raw.file, least, some_of(texts(none), kNamed)));
}

std::vector<std::string> names(const DelimitedText& text, const std::string& column, const std::string& all) {
  std::vector<std::string> words(text.rows(), all);
  if (column.empty()) return words;
  const std::size_t at = text.column(column);
  for (std::size_t j = 0; j < text.rows(); ++j) words[j] = text.text(j, at);
  return words;
}

/// Squares of 1 sigma on three axes. Throws InputError at `place`.
Vec3 variances(const std::vector<double>& told, double unit, double all, const Place& place) {
  if (told.empty()) return Vec3::Constant(all * all);
  Vec3 v;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double sigma = unit * told[told.size() == 3 ? static_cast<std::size_t>(k) : 0];
    if (sigma != 0 && !(sigma >= kLeastNoise && sigma <= kLargestNoise))
      throw InputError(place, fmt::format("a sigma is {:g} m or rad, outside {:g}..{:g}", sigma, kLeastNoise,
                                          kLargestNoise));
    v[k] = sigma * sigma;
  }
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
    for (std::size_t i = 0; i < raw_.joints[j].size(); ++i) {
      const double sign = map.joint_signs.empty() ? 1 : map.joint_signs[i];
      const double offset = map.joint_offsets.empty() ? 0 : map.joint_offsets[i];
      row.axes.push_back((sign * raw_.joints[j][i] + offset) *
                         (axes_[i].angle ? map.joints.unit : map.slide_unit));
    }
    measured(j, row);
    noise(j, row);
    if (map.inverse) turn_about(row);
    if (map.frame.empty()) row.X_MG = X_BW_ * row.X_MG;
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
  }

  /// From the frame seen from the target to the target seen from the frame, with its noise.
  static void turn_about(MeasurementRow& row) {
    const Mat3 R = row.X_MG.linear().transpose();
    Mat6 J = Mat6::Zero();
    J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = -R;
    J.topRightCorner<3, 3>() = -R * cross_matrix(row.X_MG.translation());
    row.X_MG = row.X_MG.inverse();
    row.covariance = (J * row.covariance * J.transpose()).eval();
  }

  void noise(std::size_t j, MeasurementRow& row) const {
    const TableMap& map = raw_.map;
    const bool turns = map.orientation.has_value(), lengths = !turns || map.position.has_value();
    const auto sigma_unit = [](const std::optional<NumberColumns>& numbers) {
      return numbers ? numbers->sigma_unit / numbers->sigma_coverage : 1;
    };
    const double unit = sigma_unit(map.position ? map.position : map.distance);
    const auto none = std::vector<double>();
    const Place place{raw_.file, row.line, 0};
    row.covariance.diagonal().head<3>() = variances(
        raw_.sigma_position.empty() ? none : raw_.sigma_position[j], unit, map.sigma_position, place);
    row.covariance.diagonal().tail<3>() = variances(raw_.sigma_turn.empty() ? none : raw_.sigma_turn[j],
                                                    sigma_unit(map.orientation), map.sigma_turn, place);
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

RawTable read_raw(const TableMap& map, const std::string& file, const std::string& id,
                  const fs::path& joint_file, std::string& bytes) {
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
  raw.joints = numbers(joints, map.joints.columns, false);
  if (map.position) {
    raw.position = numbers(text, map.position->columns, true);
    raw.sigma_position = numbers(text, map.position->sigma, true);
  }
  if (map.orientation) {
    raw.orientation = numbers(text, map.orientation->columns, true);
    raw.sigma_turn = numbers(text, map.orientation->sigma, true);
  }
  if (map.distance) {
    for (const auto& row : numbers(text, map.distance->columns, true)) raw.distance.push_back(row[0]);
    raw.sigma_position = numbers(text, map.distance->sigma, true);
  }
  raw.targets = names(text, map.target_column, map.target);
  raw.ids = names(text, map.id_column, map.id.empty() ? id : map.id);
  leave_out_missing(raw);
  settle_sigmas(raw.sigma_position, raw);
  settle_sigmas(raw.sigma_turn, raw);
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
