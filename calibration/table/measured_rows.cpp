#include "calibration/table/measured_rows.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/rows/row_outliers.h"
#include "calibration/table/raw_table.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {
namespace fs = std::filesystem;

constexpr double kBeyondTurn = 0.1, kBeyondSlide = 0.01;  // [rad], [m], a log may be outside an axis' range
constexpr double kFar = 50e-3, kTurned = 0.3;  // [m], [rad]: no machine is built so far from its drawing
constexpr double kMuchNearer = 5;              // by this factor another unit must fit better

void check_axes(const RawTable& raw, const RowProblem& problem, const machine::MachineDescription& machine) {
  const auto axes = row_axes(machine);
  for (const MeasurementRow& row : problem.rows) {
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
    if (!problem.nominal.forward(row.axes).matrix().allFinite())
      throw InputError(
          {raw.file, row.line, 0},
          "no pose of this machine has these axes: another machine, or another order of columns?");
  }
}

RowMachine row_machine(const machine::MachineDescription& machine) {
  if (machine.is_chain()) return ChainParameters{machine.chain().kinematics.chain, {}};
  const HexapodGeometry& geometry = machine.hexapod().geometry;
  return RowHexapod{geometry, geometry.length_offset, machine.X_BT_home};
}

class TableReader {
 public:
  TableReader(const ColumnMap& map, const machine::MachineDescription& machine, MeasuredRows& out)
      : map_(map), machine_(machine), out_(out) {}

  /// The rows of the table, its units settled.
  void read(RawTable raw) {
    const std::size_t axes = row_axes(machine_).size();
    if (raw.map.joints.columns.size() != axes)
      throw InputError({map_.file, 0, 0},
                       fmt::format("joints.columns names {} columns, machine {} has {} axes",
                                   raw.map.joints.columns.size(), machine_.name, axes));
    settle_joint_unit(raw);
    const RowProblem problem = problem_of(raw);
    check_axes(raw, problem, machine_);
    check_fit(raw);
    out_.problem.rows.insert(out_.problem.rows.end(), problem.rows.begin(), problem.rows.end());
    if (raw.map.zero_unknown)
      for (const MeasurementRow& row : problem.rows) out_.problem.with_zero.insert(row.place);
  }

 private:
  RowProblem problem_of(const RawTable& raw) const {
    RowProblem problem = out_.problem;
    problem.rows = rows_of(raw, machine_);
    problem.distances.clear();
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
    const RowProblem problem = problem_of(raw);
    const SurroundingsLayout layout(problem);
    const RowLikelihood likelihood(problem, layout, {});
    const auto fit =
        fitted_surroundings(likelihood, problem, layout, {10e-3, 20e-3, 10e-3, 10e-3, 10e-3}, 50);
    Left left;
    if (!fit) return {1e9, 1e9};
    const auto parts = parts_of(problem);
    int lengths = 0, turns = 0;
    // A few rows may be spoiled; many are no exception.
    const auto first = first_equations(problem);
    std::vector<bool> counts(parts.size(), true);
    if (static_cast<double>(spoiled_rows(fit->weights)) <=
        kSpoiledShare * static_cast<double>(problem.rows.size()))
      for (std::size_t j = 0; j < fit->weights.size(); ++j)
        for (auto i = first[j]; i < first[j + 1]; ++i)
          counts[static_cast<std::size_t>(i)] = fit->weights[j] > 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!counts[i]) continue;
      const double square = std::pow(fit->fit.error[static_cast<Eigen::Index>(i)], 2);
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
    const auto axes = row_axes(machine_);
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

  /// The same table with axes that count the other way, one after the other as long as that helps much, and
  /// their names.
  std::pair<RawTable, std::vector<std::string>> with_best_signs(const RawTable& raw, Left as_read) const {
    constexpr std::size_t kMost = 3;
    constexpr double kHelps = 0.7;
    const auto axes = row_axes(machine_);
    const auto badness = [](const Left& left) { return left.length / kFar + left.turn / kTurned; };
    RawTable best = raw;
    std::vector<std::string> names;
    for (double least = badness(as_read); names.size() < kMost;) {
      const RawTable from = best;
      std::string name;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        RawTable other = from;
        other.map.joint_signs.resize(axes.size(), 1);
        other.map.joint_signs[i] *= -1;
        const double bad = badness(left(other));
        if (!(bad < kHelps * least)) continue;
        least = bad;
        best = other;
        name = axes[i].name;
      }
      if (name.empty()) break;
      names.push_back(name);
    }
    return {best, names};
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
    other = raw;
    other.map.inverse = !raw.map.inverse;
    if (raw.map.orientation)
      suggest(other, fmt::format("poses are seen_from: {}", other.map.inverse ? "target" : "frame"));
    const auto [signed_best, names] = with_best_signs(raw, as_read);
    if (!names.empty())
      suggest(signed_best, fmt::format("{} {} the other way (`signs` of joints)", fmt::join(names, " and "),
                                       names.size() == 1 ? "counts" : "count"));
    if (raw.map.orientation) {
      const RawTable best = best_orientation(raw);
      suggest(best, "orientations are " + to_string(best.map.reading));
    }
    throw InputError(
        {raw.file, 0, 0},
        fmt::format(
            "by this machine's geometry the rows are {:.0f} mm and {:.0f} deg off (RMS), wherever "
            "the measuring frame stands: another machine, order of rows, zeros or mixed units of axes?",
            to_mm(as_read.length), to_deg(as_read.turn)));
  }

  const ColumnMap& map_;
  const machine::MachineDescription& machine_;
  MeasuredRows& out_;
};

/// Its stem; with the folder where another file has the same.
std::string name_of(const std::string& file, const std::vector<std::string>& files,
                    const std::vector<std::string>& beside) {
  const fs::path path = fs::path(file).lexically_normal();
  const auto same = [&path](const std::string& other) {
    const fs::path it = fs::path(other).lexically_normal();
    return it.stem() == path.stem() && it != path;
  };
  const bool shared =
      std::any_of(files.begin(), files.end(), same) || std::any_of(beside.begin(), beside.end(), same);
  const std::string stem = path.stem().string();
  return shared && path.has_parent_path() ? (path.parent_path() / stem).string() : stem;
}

}  // namespace

MeasuredRows read_measured_rows(const ColumnMap& map, const std::vector<std::string>& files,
                                const machine::MachineDescription& machine,
                                const std::vector<std::string>& beside) {
  MeasuredRows out;
  out.problem.nominal = row_machine(machine);
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
    RawTable raw = read_raw(table, file, name_of(file, files, beside), folder / table.joint_file, bytes);
    out.notes.insert(out.notes.end(), raw.notes.begin(), raw.notes.end());
    raw.index = static_cast<int>(out.files.size());
    out.files.push_back(file);
    reader.read(std::move(raw));
  }
  out.problem.distances = map.distances;
  out.sha256 = sha256_hex(bytes);
  return out;
}

}  // namespace understudy::calibration
