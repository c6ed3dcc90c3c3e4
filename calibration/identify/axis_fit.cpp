#include "calibration/identify/axis_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace understudy::calibration {
namespace {

using Columns = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(kAxisParameters)>;

constexpr int kRounds = 50;      // of classing and fitting; ends when no row changes side
constexpr int kRowsLeast = 20;   // of an axis
constexpr int kRowsOfSide = 10;  // fewer may be one accident
constexpr double kApart = 6;  // two lines, in scatters about them: of one hump they come out 4 apart at most
constexpr double kBetween = 4;   // noises inside of both lines: on the way
constexpr double kAlone = 1e-3;  // of a column, what the others do not make of it
constexpr double kMisfit = 4;    // standard scores, as misfit_warning() has it
constexpr auto kZero = static_cast<Eigen::Index>(AxisParameter::zero);
constexpr auto kPlay = static_cast<Eigen::Index>(AxisParameter::play);

Columns columns_of(std::span<const AxisRow> rows, const AxisFitOptions& options) {
  Columns columns = Columns::Zero(static_cast<Eigen::Index>(rows.size()), kAxisParameters);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const AxisRow& row = rows[k];
    const double angle = options.turn > 0 ? 2 * std::numbers::pi * row.commanded / options.turn : 0;
    columns.row(static_cast<Eigen::Index>(k)) << 1, 0, row.commanded, -row.velocity, std::sin(angle),
        std::cos(angle) - 1;
  }
  return columns;
}

/// The columns that are taken into the fit, in their order: each must say something that those before do not.
class Chosen {
 public:
  void try_column(const Columns& columns, const Eigen::VectorXd& weight, Eigen::Index which) {
    Eigen::VectorXd rest = weight.cwiseProduct(columns.col(which));
    const double whole = rest.norm();
    for (int twice = 0; twice < 2; ++twice)
      for (const Eigen::VectorXd& unit : units_) rest -= unit.dot(rest) * unit;
    if (!(rest.norm() > kAlone * whole) || whole == 0) return;
    units_.push_back(rest.normalized());
    which_.push_back(which);
  }
  const std::vector<Eigen::Index>& which() const { return which_; }
  bool has(Eigen::Index which) const {
    return std::find(which_.begin(), which_.end(), which) != which_.end();
  }

 private:
  std::vector<Eigen::VectorXd> units_;
  std::vector<Eigen::Index> which_;
};

struct Solution {
  AxisFit::Vector value = AxisFit::Vector::Zero();
  AxisFit::Matrix inverse = AxisFit::Matrix::Zero();  // of the normal equations
  std::vector<Eigen::Index> which;
  Eigen::VectorXd residual;  // of every row
  double squares = 0;        // of the rows that are used
  Eigen::Index used = 0;
};

Solution solve(const Columns& columns, const Eigen::VectorXd& y, const Eigen::VectorXd& used) {
  Chosen chosen;
  for (const Eigen::Index which :
       {kZero, kPlay, Eigen::Index{2}, Eigen::Index{3}, Eigen::Index{4}, Eigen::Index{5}})
    chosen.try_column(columns, used, which);
  Solution solution;
  solution.which = chosen.which();
  const auto count = static_cast<Eigen::Index>(solution.which.size());
  Eigen::MatrixXd design(columns.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j)
    design.col(j) = columns.col(solution.which[static_cast<std::size_t>(j)]);
  const Eigen::VectorXd scale = (used.asDiagonal() * design).colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = design * scale.asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * used.asDiagonal() * scaled;
  const Eigen::LLT<Eigen::MatrixXd> llt(normal);
  const Eigen::VectorXd found = scale.asDiagonal() * llt.solve(scaled.transpose() * used.asDiagonal() * y);
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * llt.solve(Eigen::MatrixXd::Identity(count, count)) * scale.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index at = solution.which[static_cast<std::size_t>(i)];
    solution.value[at] = found[i];
    for (Eigen::Index j = 0; j < count; ++j)
      solution.inverse(at, solution.which[static_cast<std::size_t>(j)]) = inverse(i, j);
  }
  solution.residual = y - design * found;
  solution.squares = solution.residual.cwiseProduct(used).squaredNorm();
  solution.used = static_cast<Eigen::Index>(used.sum());
  return solution;
}

/// Two lines a play apart, or one.
class Fitter {
 public:
  Fitter(std::span<const AxisRow> rows, const AxisFitOptions& options)
      : rows_(rows), options_(options), columns_(columns_of(rows, options)), y_(count()) {
    for (std::size_t k = 0; k < rows.size(); ++k)
      y_[static_cast<Eigen::Index>(k)] = rows[k].measured - rows[k].commanded;
    used_ = Eigen::VectorXd::Ones(count());
  }

  Solution one_line() {
    columns_.col(kPlay).setZero();
    used_.setOnes();
    return solve(columns_, y_, used_);
  }

  /// Whether there are two. Begins at those that part the rows at their middle.
  bool two_lines(Solution& solution) {
    solution = one_line();
    const double middle = 0.5 * (solution.residual.maxCoeff() + solution.residual.minCoeff());
    Eigen::VectorXd off = solution.residual.array() - middle;
    for (int round = 0; round < kRounds; ++round) {
      const bool classed_anew = class_rows(off);
      if (upper_ < kRowsOfSide || count() - upper_ < kRowsOfSide) return false;
      const Eigen::VectorXd used_before = used_;
      leave_out(solution, round);
      if (round > 1 && !classed_anew && used_ == used_before) return are_apart(solution);
      solution = solve(columns_, y_, used_);
      off = solution.residual + solution.value[kPlay] * columns_.col(kPlay);
    }
    return are_apart(solution);
  }

  int upper() const { return upper_; }
  int side_changes() const {
    int changes = 0;
    for (Eigen::Index k = 1; k < count(); ++k)
      changes += columns_(k, kPlay) != columns_(k - 1, kPlay) ? 1 : 0;
    return changes;
  }

 private:
  Eigen::Index count() const { return static_cast<Eigen::Index>(rows_.size()); }

  /// Each row to the side that it is on; whether one has changed.
  bool class_rows(const Eigen::VectorXd& off) {
    bool changed = false;
    upper_ = 0;
    for (Eigen::Index k = 0; k < count(); ++k) {
      const double side = off[k] >= 0 ? 0.5 : -0.5;
      changed = changed || side != columns_(k, kPlay);
      columns_(k, kPlay) = side;
      upper_ += side > 0 ? 1 : 0;
    }
    return changed;
  }

  /// Rows between both lines, and those around them in time: the axis crosses its play, or floats in it.
  void leave_out(const Solution& solution, int round) {
    used_.setOnes();
    if (round == 0) return;
    const double half = solution.value[kPlay] / 2 - kBetween * options_.noise;
    std::vector<double> between;
    for (Eigen::Index k = 0; k < count(); ++k)
      if (std::abs(solution.residual[k] + solution.value[kPlay] * columns_(k, kPlay)) < half)
        between.push_back(time(k));
    for (Eigen::Index k = 0; k < count(); ++k) {
      const auto next = std::lower_bound(between.begin(), between.end(), time(k) - options_.around);
      if (next != between.end() && *next <= time(k) + options_.around) used_[k] = 0;
    }
  }

  bool are_apart(const Solution& solution) const {
    // Of all rows: most are at an end of the play, if there is one.
    const double scatter =
        std::max(options_.noise, std::sqrt(solution.residual.squaredNorm() / static_cast<double>(count())));
    return solution.value[kPlay] > kApart * scatter;
  }

  double time(Eigen::Index k) const { return rows_[static_cast<std::size_t>(k)].time; }

  std::span<const AxisRow> rows_;
  AxisFitOptions options_;
  Columns columns_;
  Eigen::VectorXd y_, used_;
  int upper_ = 0;
};

/// In the order of AxisParameter.
std::array<std::string, kAxisParameters> reasons(const Solution& solution, const AxisFitOptions& options) {
  std::array<std::string, kAxisParameters> why{"",
                                               "the axis is seen on one side of its play only",
                                               "the axis does not move",
                                               "its speed does not change",
                                               "it moves too little of a motor's turn",
                                               "it moves too little of a motor's turn"};
  if (!(options.turn > 0)) why[4] = why[5] = "the travel of a motor's turn is not known";
  for (const Eigen::Index which : solution.which) why[static_cast<std::size_t>(which)].clear();
  return why;
}

}  // namespace

const char* to_string(AxisParameter parameter) {
  constexpr std::array<const char*, kAxisParameters> kWords{"zero", "play", "scale", "lag", "sine", "cosine"};
  return kWords[static_cast<std::size_t>(parameter)];
}

double AxisFit::sigma(AxisParameter p) const {
  return std::sqrt(covariance(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p)));
}

AxisFit fit_axis(std::span<const AxisRow> rows, const AxisFitOptions& options) {
  AxisFit fit;
  fit.rows = static_cast<int>(rows.size());
  if (fit.rows < kRowsLeast) {
    fit.untold.fill("there are too few rows in motion");
    return fit;
  }
  Fitter fitter(rows, options);
  Solution solution;
  if (fitter.two_lines(solution)) {
    fit.upper = fitter.upper();
    fit.side_changes = fitter.side_changes();
  } else {
    solution = fitter.one_line();
  }
  fit.value = solution.value;
  fit.untold = reasons(solution, options);
  fit.left_out = fit.rows - static_cast<int>(solution.used);
  fit.degrees_of_freedom = static_cast<int>(solution.used) - static_cast<int>(solution.which.size());
  fit.chi_square = solution.squares / (options.noise * options.noise);
  fit.residual_rms = std::sqrt(solution.squares / static_cast<double>(solution.used));
  const double n = fit.degrees_of_freedom;
  const double more = fit.chi_square > n + kMisfit * std::sqrt(2 * n) ? fit.chi_square / n : 1;
  fit.covariance = more * options.noise * options.noise * solution.inverse;
  return fit;
}

}  // namespace understudy::calibration
