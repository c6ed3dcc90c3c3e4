#include "calibration/table/measured_rows.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "calibration/rows/row_fit.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr double kOffRotation = 1e-3;  // of a quaternion's length, of a matrix' entries: digits of an export
constexpr double kBeyondTurn = 0.1, kBeyondSlide = 0.01;  // [rad], [m], a log may be outside an axis' range
constexpr double kFar = 50e-3, kTurned = 0.3;  // [m], [rad]: no machine is built so far from its drawing
constexpr double kMuchNearer = 5;              // by this factor another unit must fit better

/// The numbers of one table, still in its own units.
struct RawTable {
  TableMap map;
  std::string file;
  int index = 0;
  std::vector<std::vector<double>> joints, position, orientation, sigma_position, sigma_turn;
  std::vector<double> distance;
  std::vector<int> lines;
  std::vector<std::string> targets, ids;
};

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

RawTable read_raw(const TableMap& map, const std::string& file, const fs::path& joint_file,
                  std::string& bytes) {
  RawTable raw;
  raw.map = map;
  raw.file = file;
  const std::string content = map.read && map.read->file == file ? map.read->text : read_file(file);
  bytes += content;
  const DelimitedText text(content, file, map.format);
  for (std::size_t j = 0; j < text.rows(); ++j) raw.lines.push_back(text.line(j));
  if (map.joint_file.empty()) {
    raw.joints = numbers(text, map.joints.columns);
  } else {
    const std::string log = read_file(joint_file);
    bytes += log;
    const DelimitedText joints(log, joint_file.string(), map.joint_format);
    if (joints.rows() != text.rows())
      throw InputError({file, 0, 0}, fmt::format("has {} rows, {} has {}: rows are joined by their number",
                                                 text.rows(), joint_file.string(), joints.rows()));
    raw.joints = numbers(joints, map.joints.columns);
  }
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
      : raw_(raw), chain_(machine.chain().kinematics.chain), X_BW_(machine.X_WB.inverse()) {}

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
      row.axes.push_back(raw_.joints[j][i] * (chain_.axes[i].angle ? map.joints.unit : map.slide_unit));
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
    const double unit = map.position ? map.position->sigma_unit : map.distance ? map.distance->sigma_unit : 1;
    const auto none = std::vector<double>();
    row.covariance.diagonal().head<3>() =
        variances(raw_.sigma_position.empty() ? none : raw_.sigma_position[j], unit, map.sigma_position);
    row.covariance.diagonal().tail<3>() = variances(raw_.sigma_turn.empty() ? none : raw_.sigma_turn[j],
                                                    turns ? map.orientation->sigma_unit : 1, map.sigma_turn);
    const auto diagonal = row.covariance.diagonal();
    row.noise_told =
        (!lengths || diagonal.head<3>().minCoeff() > 0) && (!turns || diagonal.tail<3>().minCoeff() > 0);
    if (!row.noise_told) row.covariance.setZero();
  }

  const RawTable& raw_;
  const kinematics::Chain& chain_;
  Pose X_BW_;
};

void check_axes(const RawTable& raw, const RowProblem& problem, const machine::MachineDescription& machine) {
  const auto& axes = machine.chain().kinematics.chain.axes;
  for (const MeasurementRow& row : problem.rows)
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double beyond = axes[i].angle ? kBeyondTurn : kBeyondSlide, q = row.axes[i];
      if (q >= axes[i].lower - beyond && q <= axes[i].upper + beyond) continue;
      const double unit = axes[i].angle ? kDegree : kMillimetre;
      throw InputError(
          {raw.file, row.line, 0},
          fmt::format("axis {} is {:.4g} {}, where this machine's range is {:.4g} to {:.4g}: another "
                      "machine, or another unit?",
                      axes[i].name, q / unit, axes[i].angle ? "deg" : "mm", axes[i].lower / unit,
                      axes[i].upper / unit));
    }
}

class TableReader {
 public:
  TableReader(const ColumnMap& map, const machine::MachineDescription& machine, MeasuredRows& out)
      : map_(map), machine_(machine), out_(out) {}

  /// The rows of the table, its units settled.
  void read(RawTable raw) {
    const std::size_t axes = machine_.chain().kinematics.chain.axes.size();
    if (raw.map.joints.columns.size() != axes)
      throw InputError({map_.file, 0, 0},
                       fmt::format("joints.columns names {} columns, machine {} has {} axes",
                                   raw.map.joints.columns.size(), machine_.name, axes));
    settle_joint_unit(raw);
    const RowProblem problem = rows_of(raw);
    check_axes(raw, problem, machine_);
    check_fit(raw);
    out_.problem.rows.insert(out_.problem.rows.end(), problem.rows.begin(), problem.rows.end());
    if (raw.map.zero_unknown)
      for (const MeasurementRow& row : problem.rows) out_.problem.with_zero.insert(row.place);
  }

 private:
  RowProblem rows_of(const RawTable& raw) const {
    RowProblem problem = out_.problem;
    problem.rows.clear();
    problem.distances.clear();
    const RowMaker maker(raw, machine_);
    for (std::size_t j = 0; j < raw.lines.size(); ++j) problem.rows.push_back(maker.row(j));
    if (raw.map.zero_unknown)
      for (const MeasurementRow& row : problem.rows) problem.with_zero.insert(row.place);
    return problem;
  }

  /// What the nominal machine leaves of the table alone: RMS of lengths [m] and of turns [rad] on each axis.
  struct Left {
    double length = 0, turn = 0;
    bool far() const { return length > kFar || turn > kTurned; }
    bool much_nearer(const Left& other) const {
      return !far() &&
             (other.length > kFar ? kMuchNearer * length < other.length : kMuchNearer * turn < other.turn);
    }
  };
  Left left(const RawTable& raw) const {
    const RowProblem problem = rows_of(raw);
    const SurroundingsLayout layout(problem);
    const RowLikelihood likelihood(problem, layout, {});
    const auto fit =
        fitted_surroundings(likelihood, problem, layout, {10e-3, 20e-3, 10e-3, 10e-3, 10e-3}, 50);
    Left left;
    if (!fit) return {1e9, 1e9};
    const auto parts = parts_of(problem);
    int lengths = 0, turns = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double square = std::pow(fit->error[static_cast<Eigen::Index>(i)], 2);
      const bool turn = parts[i] == NoisePart::turn;
      (turn ? left.turn : left.length) += square;
      ++(turn ? turns : lengths);
    }
    left.length = std::sqrt(left.length / std::max(1, lengths));
    left.turn = std::sqrt(left.turn / std::max(1, turns));
    return left;
  }

  /// By size: no log of an arm stays within 6.5 degrees on all axes, and none has 6.5 rad, more than a turn.
  /// check_fit() looks at the answer.
  void settle_joint_unit(RawTable& raw) {
    constexpr double kTurn = 6.5;
    const auto& axes = machine_.chain().kinematics.chain.axes;
    if (raw.map.joint_unit_told ||
        std::none_of(axes.begin(), axes.end(), [](const auto& axis) { return axis.angle; }))
      return;
    double largest = 0;
    for (const auto& row : raw.joints)
      for (std::size_t i = 0; i < row.size(); ++i)
        if (axes[i].angle) largest = std::max(largest, std::abs(row[i]));
    raw.map.joints.unit = largest > kTurn ? kDegree : 1;
    out_.notes.push_back(
        fmt::format("{}: joints are read as {}", raw.file, largest > kTurn ? "degrees" : "radians"));
  }

  /// The same table with its orientations read in the way that leaves least.
  RawTable best_orientation(const RawTable& raw) const {
    RawTable best = raw;
    double least = std::numeric_limits<double>::infinity();
    for (const OrientationReading& reading : other_readings(raw.map.reading)) {
      RawTable other = raw;
      other.map.reading = reading;
      const double turn = left(other).turn;
      if (turn >= least) continue;
      least = turn;
      best = other;
    }
    return best;
  }

  /// Refuses what no place of the measuring frame fits, with the reading that would fit.
  void check_fit(const RawTable& raw) const {
    const Left as_read = left(raw);
    if (!as_read.far()) return;
    const auto suggest = [&](const RawTable& other, const std::string& what) {
      if (left(other).much_nearer(as_read))
        throw InputError({raw.file, 0, 0},
                         fmt::format("the rows fit this machine only if {}: change the map", what));
    };
    RawTable other = raw;
    other.map.joints.unit = raw.map.joints.unit == 1 ? kDegree : 1;
    suggest(other, fmt::format("joints are {}", raw.map.joints.unit == 1 ? "degrees" : "radians"));
    for (const auto& [name, unit] : {std::pair("mm", 1e-3), {"m", 1.0}, {"um", 1e-6}, {"inch", kInch}}) {
      other = raw;
      for (auto* lengths : {&other.map.position, &other.map.distance})
        if (*lengths) (*lengths)->unit = unit;
      suggest(other, fmt::format("lengths are in {}", name));
    }
    if (raw.map.orientation) {
      const RawTable best = best_orientation(raw);
      suggest(best, "orientations are " + to_string(best.map.reading));
    }
    throw InputError(
        {raw.file, 0, 0},
        fmt::format(
            "by this machine's geometry the rows are {:.0f} mm and {:.0f} deg off (RMS), wherever "
            "the measuring frame stands: another machine, order of rows, or signs or mixed units of axes?",
            to_mm(as_read.length), to_deg(as_read.turn)));
  }

  const ColumnMap& map_;
  const machine::MachineDescription& machine_;
  MeasuredRows& out_;
};

}  // namespace

MeasuredRows read_measured_rows(const ColumnMap& map, const std::vector<std::string>& files,
                                const machine::MachineDescription& machine) {
  MeasuredRows out;
  out.problem.nominal = {machine.chain().kinematics.chain, {}};
  const Pose X_BW = machine.X_WB.inverse();
  for (const KnownPlace& place : map.targets)
    out.problem.targets[place.name] = make_pose(Mat3(Mat3::Identity()), place.position);
  for (const KnownPlace& place : map.points) out.problem.points[place.name] = X_BW * place.position;
  for (const KnownPlace& place : map.anchors) out.problem.anchors[place.name] = X_BW * place.position;
  const fs::path folder = fs::path(map.file).parent_path();
  std::vector<std::pair<TableMap, std::string>> tables;
  for (const TableMap& table : map.tables) {
    if (!files.empty() && (map.tables.size() > 1 || !table.file.empty()))
      throw InputError({map.file, 0, 0}, "the map names its files itself: give no others");
    if (files.empty() && table.file.empty())
      throw InputError({map.file, 0, 0}, "names no file: give one on the command line, or `file` in the map");
    if (files.empty()) tables.emplace_back(table, (folder / table.file).string());
    for (const std::string& file : files) tables.emplace_back(table, file);
  }
  std::string bytes;
  TableReader reader(map, machine, out);
  for (const auto& [table, file] : tables) {
    RawTable raw = read_raw(table, file, folder / table.joint_file, bytes);
    raw.index = static_cast<int>(out.files.size());
    out.files.push_back(file);
    reader.read(std::move(raw));
  }
  out.problem.distances = map.distances;
  out.sha256 = sha256_hex(bytes);
  return out;
}

}  // namespace understudy::calibration
