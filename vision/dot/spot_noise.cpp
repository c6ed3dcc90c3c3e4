#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "vision/dot/spot.h"

namespace understudy::vision {
namespace {

constexpr double kQuantisation = 1.0 / 12;  // grey levels^2, of rounding
// Grain radii tried [px]; below a third of a pixel neighbours are independent, above the spot is one grain.
constexpr std::array<double, 7> kGrainRadii = {0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8};

using Modes = Eigen::Matrix<double, Eigen::Dynamic, 6>;
using ModeMatrix = Eigen::Matrix<double, 6, 6>;

/// The window's pixels, and the measurement made linear: a disturbance n of the pixels moves the moments
/// (flux, both coordinates, three of spread; in units of the spot) by response^T n, and with them the
/// Gaussian by shape * moments.
struct Linear {
  std::vector<Eigen::Vector2i> pixel;
  Eigen::VectorXd model, residual;
  Modes shape, response;
  Eigen::Matrix2d root;  ///< of the spread: units of the spot to pixels

  Eigen::Index size() const { return model.size(); }
};

/// Entries at the pixels themselves and at pairs of neighbours.
struct Scatter {
  double at_pixels = 0;
  double at_neighbours = 0;
};

void fill_modes(Linear& l, const Spot& spot, const Eigen::VectorXd& weight) {
  // The window moves and grows with what it measures; for a Gaussian that weakens its hold on both.
  const double h = spot.window * spot.window / 2, tail = 1 / (std::exp(h) - 1);
  const double hold_on_centre = 1 - h * tail;
  const double hold_on_spread = hold_on_centre - h * (h * std::exp(h) * tail * tail - tail);
  const double flux = weight.dot(l.model);
  const Eigen::Matrix2d to_units = l.root.inverse();
  l.shape.resize(l.size(), 6);
  l.response.resize(l.size(), 6);
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    const Vec2 z = to_units * (l.pixel[static_cast<std::size_t>(i)].cast<double>() - spot.centre);
    const double m = l.model[i], w = weight[i] / flux;
    l.shape.row(i) << m, m * z.x(), m * z.y(), m * (z.x() * z.x() - 1) / 2, m * z.x() * z.y(),
        m * (z.y() * z.y() - 1) / 2;
    const double c = w / hold_on_centre, s = w / std::max(0.1, hold_on_spread);
    l.response.row(i) << w, c * z.x(), c * z.y(), s * (z.x() * z.x() - hold_on_centre), s * z.x() * z.y(),
        s * (z.y() * z.y() - hold_on_centre);
  }
}

Linear linearise(const Image& image, const Spot& spot) {
  const Eigen::Matrix2d inverse = spot.spread.inverse();
  const int rx = static_cast<int>(std::ceil(spot.window * std::sqrt(spot.spread(0, 0)))) + 1;
  const int ry = static_cast<int>(std::ceil(spot.window * std::sqrt(spot.spread(1, 1)))) + 1;
  const int cx = static_cast<int>(std::lround(spot.centre.x())),
            cy = static_cast<int>(std::lround(spot.centre.y()));
  Linear l;
  std::vector<double> weight, model, residual;
  for (int y = std::max(0, cy - ry); y <= std::min(image.height() - 1, cy + ry); ++y) {
    for (int x = std::max(0, cx - rx); x <= std::min(image.width() - 1, cx + rx); ++x) {
      const Vec2 d(x - spot.centre.x(), y - spot.centre.y());
      const double distance = normalised_distance(spot, inverse, x, y);
      const double w = window_weight(distance, d.norm(), spot.window);
      if (w <= 0) continue;
      l.pixel.emplace_back(x, y);
      weight.push_back(w);
      model.push_back(spot.amplitude() * std::exp(-0.5 * distance * distance));
      residual.push_back(image.at(x, y) - spot.around.level - spot.around.slope.dot(d) - model.back());
    }
  }
  const auto count = static_cast<Eigen::Index>(weight.size());
  l.model = Eigen::VectorXd::Map(model.data(), count);
  l.residual = Eigen::VectorXd::Map(residual.data(), count);
  l.root = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spot.spread).operatorSqrt();
  fill_modes(l, spot, Eigen::VectorXd::Map(weight.data(), count));
  return l;
}

/// Calls visit(i, j) for pixels side by side in a row, and one above the other when that is next in the list.
template <typename Visit>
void for_neighbours(const Linear& l, Visit visit) {
  std::size_t below = 0;
  for (std::size_t i = 0; i < l.pixel.size(); ++i) {
    if (i + 1 < l.pixel.size() && l.pixel[i + 1] == l.pixel[i] + Eigen::Vector2i(1, 0)) {
      visit(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i + 1));
    }
    const Eigen::Vector2i wanted = l.pixel[i] + Eigen::Vector2i(0, 1);
    const auto before = [&](const Eigen::Vector2i& p) {
      return p.y() < wanted.y() || (p.y() == wanted.y() && p.x() < wanted.x());
    };
    while (below < l.pixel.size() && before(l.pixel[below])) ++below;
    if (below < l.pixel.size() && l.pixel[below] == wanted) {
      visit(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(below));
    }
  }
}

/// What is left of a disturbance of covariance C after the fit took its share, (1 - S R^T) C (1 - R S^T),
/// summed over pixels and over neighbours. `through` is C R, `entry(i, j)` C itself.
template <typename Entry>
Scatter left_over(const Linear& l, const Modes& through, Entry entry) {
  const ModeMatrix moments = l.response.transpose() * through;
  const auto element = [&](Eigen::Index i, Eigen::Index j) {
    return entry(i, j) - l.shape.row(i).dot(through.row(j)) - through.row(i).dot(l.shape.row(j)) +
           l.shape.row(i) * moments * l.shape.row(j).transpose();
  };
  Scatter s;
  for (Eigen::Index i = 0; i < l.size(); ++i) s.at_pixels += element(i, i);
  for_neighbours(l, [&](Eigen::Index i, Eigen::Index j) { s.at_neighbours += element(i, j); });
  return s;
}

struct Grain {
  Scatter scatter;  ///< expected, for speckle of contrast 1 per pixel
  Mat6 moments;     ///< covariance of the moments that goes with it
};

/// Speckle multiplies the light: covariance M M' exp(-lag^2 / 2 radius^2).
Grain grain_of(const Linear& l, double radius) {
  const auto falloff = [&](int lag) { return std::exp(-lag * lag / (2 * radius * radius)); };
  std::array<double, 256> table{};
  for (int lag = 0; lag < 256; ++lag) table[static_cast<std::size_t>(lag)] = falloff(lag);
  const auto entry = [&](Eigen::Index i, Eigen::Index j) {
    const Eigen::Vector2i lag =
        (l.pixel[static_cast<std::size_t>(i)] - l.pixel[static_cast<std::size_t>(j)]).cwiseAbs();
    if (lag.x() > 255 || lag.y() > 255) return 0.0;
    return l.model[i] * l.model[j] * table[static_cast<std::size_t>(lag.x())] *
           table[static_cast<std::size_t>(lag.y())];
  };
  const int reach = static_cast<int>(std::ceil(5 * radius));
  Modes through = Modes::Zero(l.size(), 6);
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    for (Eigen::Index j = 0; j < l.size(); ++j) {
      const int rows = l.pixel[static_cast<std::size_t>(j)].y() - l.pixel[static_cast<std::size_t>(i)].y();
      if (rows < -reach) continue;
      if (rows > reach) break;
      through.row(i) += entry(i, j) * l.response.row(j);
    }
  }
  return {left_over(l, through, entry), l.response.transpose() * through};
}

/// Covariance of the moments by speckle whose strength and grain are read from the picture itself: the pair
/// for which pixels and neighbours are expected to scatter as they do.
Mat6 estimated_speckle(const Linear& l, const Eigen::VectorXd& noise) {
  Modes through = noise.asDiagonal() * l.response;
  const Scatter of_noise =
      left_over(l, through, [&](Eigen::Index i, Eigen::Index j) { return i == j ? noise[i] : 0.0; });
  Scatter seen{l.residual.squaredNorm(), 0};
  for_neighbours(
      l, [&](Eigen::Index i, Eigen::Index j) { seen.at_neighbours += l.residual[i] * l.residual[j]; });
  const Scatter speckle{seen.at_pixels - of_noise.at_pixels, seen.at_neighbours - of_noise.at_neighbours};
  // A scatter that noise alone explains (two standard deviations of its own sum) is not speckle.
  if (speckle.at_pixels < 2 * std::sqrt(2 * noise.squaredNorm())) return Mat6::Zero();

  const double ratio = speckle.at_neighbours / speckle.at_pixels;
  std::optional<Grain> finer;
  for (const double radius : kGrainRadii) {
    Grain grain = grain_of(l, radius);
    if (!(grain.scatter.at_pixels > 0)) break;
    const double expected = grain.scatter.at_neighbours / grain.scatter.at_pixels;
    const double strength = speckle.at_pixels / grain.scatter.at_pixels;
    if (expected >= ratio) {
      if (!finer) return strength * grain.moments;
      const double before = finer->scatter.at_neighbours / finer->scatter.at_pixels;
      const double t = expected > before ? std::clamp((ratio - before) / (expected - before), 0.0, 1.0) : 1;
      return (1 - t) * speckle.at_pixels / finer->scatter.at_pixels * finer->moments +
             t * strength * grain.moments;
    }
    finer = grain;
  }
  return finer ? Mat6(speckle.at_pixels / finer->scatter.at_pixels * finer->moments) : Mat6::Zero();
}

}  // namespace

double speckle_area_px2(double wavelength, double aperture_sine, double px_per_metre) {
  const double grain = px_per_metre * wavelength / aperture_sine;
  return grain * grain / 3.14159265358979323846;
}

SpotScatter spot_scatter(const Image& image, const Spot& spot, const DotOptions& options) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const Linear l = linearise(image, spot);
  if (l.size() < 9) return {Eigen::Matrix2d::Constant(kUnknown), kUnknown};
  const double floor = std::max(spot.around.variance, kQuantisation);
  const Eigen::VectorXd noise = (floor + options.grey_per_electron * l.model.array()).matrix();
  Mat6 moments = l.response.transpose() * noise.asDiagonal() * l.response;
  Eigen::Matrix<double, Eigen::Dynamic, 2> place(l.size(), 2);
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    place.row(i) = (l.pixel[static_cast<std::size_t>(i)].cast<double>() - spot.centre).transpose();
  }
  const Eigen::Matrix<double, 6, 2> by_slope = l.response.transpose() * place;
  moments += by_slope * spot.around.slope_covariance * by_slope.transpose();
  if (options.speckle_area_px2 < 0) {
    moments += estimated_speckle(l, noise);
  } else {
    const Eigen::VectorXd grains = options.speckle_area_px2 * l.model.array().square().matrix();
    moments += l.response.transpose() * grains.asDiagonal() * l.response;
  }
  return {l.root * moments.block<2, 2>(1, 1) * l.root.transpose(),
          std::sqrt(std::max(moments(3, 3), moments(5, 5)))};
}

}  // namespace understudy::vision
