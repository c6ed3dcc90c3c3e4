"""An estimator of one's own against ours: on one measured machine, and in the benchmark.

Mine is Gauss and Newton on the measured poses' errors, with derivatives by differences. It is the maximum-likelihood
estimate, so that it must find what ours finds; and it is Python, so that one sees what that costs.

    python3 examples/python/compare_estimators.py [TRIALS]
"""
import sys
import time

import numpy as np

import understudy


def mine(problem):
    """The parameters that make the measured poses likeliest, and their covariance."""
    whiten = np.linalg.inv(np.linalg.cholesky(problem.covariances))

    def whitened(parameters):
        return np.einsum("nij,nj->ni", whiten, problem.residuals(parameters)).ravel()

    parameters, step = problem.nominal, 1e-5  # [m]: far above rounding, far below what bends a residual
    for _ in range(20):
        here = whitened(parameters)
        columns = [(whitened(parameters + step * axis) - whitened(parameters - step * axis)) / (2 * step)
                   for axis in np.eye(len(parameters))]
        rates = np.stack(columns, axis=1)
        by = np.linalg.lstsq(rates, -here, rcond=1e-7)[0]
        parameters = parameters + by
        if np.abs(by).max() < 1e-9:
            break
    return parameters, np.linalg.pinv(rates.T @ rates)


def one_machine():
    machine = understudy.Machine("hexapod")
    axes, poses = understudy.sample_poses(machine, 24, as_built="manufactured", seed=3)
    found = {}
    for estimator in ("maximum_likelihood", "robust", mine):
        began = time.perf_counter()
        result = understudy.calibrate(machine, axes, poses, noise=(20e-6, 0.2e-3), estimator=estimator)
        seconds = time.perf_counter() - began
        found[result.estimator] = result
        print(f"{result.estimator:20} chi-square {result.chi_square:6.1f} of {result.degrees_of_freedom}, tip known to "
              f"{1e6 * result.tip_sigma:.1f} um, {1e3 * seconds:.0f} ms")
    apart = np.abs(found["mine"].after - found["maximum_likelihood"].after) / found["maximum_likelihood"].sigma
    print(f"mine is at most {apart.max():.3f} sigma from maximum_likelihood")
    return apart.max() < 0.05


def benchmark(trials):
    result = understudy.benchmark_calibration("hexapod", ["maximum_likelihood", "robust", mine], trials=trials, poses=[12],
                                              disturbances=["none", "outliers"], seed=1)
    for standing in result["ranking"]:
        print(standing)


if __name__ == "__main__":
    agrees = one_machine()
    benchmark(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
    sys.exit(0 if agrees else 1)
