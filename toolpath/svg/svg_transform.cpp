#include "toolpath/svg/svg_transform.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

// Of the longest side of what a unit square becomes, its height: less is a line to a printer of any size.
constexpr double kFlat = 1e-6;

struct Function {
  std::string name;
  std::vector<double> numbers;
};

[[noreturn]] void refuse(const Function& function, const char* counts) {
  throw InputError(
      fmt::format("{} has {} numbers, it takes {}", function.name, function.numbers.size(), counts));
}

SvgTransform matrix(double a, double b, double c, double d, double e, double f) {
  SvgTransform t;
  t.matrix() << a, c, e, b, d, f, 0, 0, 1;
  return t;
}

SvgTransform rotation(const std::vector<double>& v) {
  const double c = std::cos(v[0] * kDegree), s = std::sin(v[0] * kDegree);
  const SvgTransform turn = matrix(c, s, -s, c, 0, 0);
  if (v.size() == 1) return turn;
  return matrix(1, 0, 0, 1, v[1], v[2]) * turn * matrix(1, 0, 0, 1, -v[1], -v[2]);
}

SvgTransform transform_of(const Function& function) {
  const auto& v = function.numbers;
  const std::string& name = function.name;
  if (name == "matrix") {
    if (v.size() != 6) refuse(function, "6");
    return matrix(v[0], v[1], v[2], v[3], v[4], v[5]);
  }
  if (name == "translate" || name == "scale") {
    if (v.empty() || v.size() > 2) refuse(function, "1 or 2");
    const double second = v.size() == 2 ? v[1] : name == "scale" ? v[0] : 0;
    return name == "scale" ? matrix(v[0], 0, 0, second, 0, 0) : matrix(1, 0, 0, 1, v[0], second);
  }
  if (name == "rotate") {
    if (v.size() != 1 && v.size() != 3) refuse(function, "1 or 3");
    return rotation(v);
  }
  if (name == "skewX" || name == "skewY") {
    if (v.size() != 1) refuse(function, "1");
    const double slope = std::tan(v[0] * kDegree);
    return name == "skewX" ? matrix(1, 0, slope, 1, 0, 0) : matrix(1, slope, 0, 1, 0, 0);
  }
  throw InputError(fmt::format("'{}' is none of matrix, translate, scale, rotate, skewX, skewY", name));
}

std::vector<double> numbers_in(const std::string& text) {
  std::string spaced = text;
  std::ranges::replace(spaced, ',', ' ');
  std::vector<double> numbers;
  for (std::size_t at = 0; at < spaced.size();) {
    if (std::isspace(static_cast<unsigned char>(spaced[at]))) {
      ++at;
      continue;
    }
    const std::size_t end = std::min(spaced.find_first_of(" \t\r\n", at), spaced.size());
    double number = 0;
    const char* const last = spaced.data() + end;
    const auto [stop, error] = std::from_chars(spaced.data() + at, last, number);
    if (error != std::errc() || stop != last || !std::isfinite(number))
      throw InputError(fmt::format("'{}' is not a number", spaced.substr(at, end - at)));
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

std::vector<Function> functions_in(const std::string& text) {
  constexpr const char* kBetween = " \t\r\n,";
  std::vector<Function> functions;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string::npos;
       at = text.find_first_not_of(kBetween, at)) {
    const std::size_t open = text.find('(', at), close = text.find(')', at);
    if (open == std::string::npos || close == std::string::npos || close < open)
      throw InputError(fmt::format("'{}' is no function with numbers in brackets", text.substr(at)));
    std::string name = text.substr(at, open - at);
    name.erase(name.find_last_not_of(" \t\r\n") + 1);
    functions.push_back({name, numbers_in(text.substr(open + 1, close - open - 1))});
    at = close + 1;
  }
  return functions;
}

}  // namespace

SvgTransform svg_transform(const std::string& text) {
  SvgTransform product = SvgTransform::Identity();
  for (const Function& function : functions_in(text)) product = product * transform_of(function);
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(product.linear());
  const double longest = svd.singularValues()(0), shortest = svd.singularValues()(1);
  if (!(longest > 0) || !std::isfinite(longest) || !(shortest > kFlat * longest))
    throw InputError(fmt::format("it has no inverse (determinant {:g}): the drawing becomes a {}",
                                 product.linear().determinant(), longest > 0 ? "line" : "point"));
  return product;
}

}  // namespace understudy::toolpath
