// Quantiles of the distributions that residuals and errors are held against.
#pragma once

namespace understudy {

/// What a chi-squared number of `degrees_of_freedom` (1 or more) exceeds with `probability`, in (0, 1).
double chi_squared_exceeded(int degrees_of_freedom, double probability);

/// What a standard normal number is below with `probability`, in (0, 1).
double normal_quantile(double probability);

/// Probability that a standard normal number is below `x`.
double normal_below(double x);

}  // namespace understudy
