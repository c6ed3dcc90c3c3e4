// Options that are seeds.
#pragma once

#include <CLI/App.hpp>

namespace understudy::cli {

/// Accepts whole numbers from 0 to 2^64 - 1 as they are written; CLI11 alone would wrap others.
CLI::Validator seed_check();

}  // namespace understudy::cli
