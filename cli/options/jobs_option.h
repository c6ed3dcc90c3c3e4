// The option -j, --jobs of commands whose result does not depend on the number of threads.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace understudy::cli {

/// Adds the option; `threads` becomes as many as the processor runs at once until it is given.
void add_jobs(CLI::App& command, int& threads,
              const std::string& about = "threads; the result does not depend on it");
/// Throws InputError outside 1..1024.
void check_jobs(int threads);

}  // namespace understudy::cli
