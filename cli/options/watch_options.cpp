#include "cli/options/watch_options.h"

#include <CLI/CLI.hpp>

namespace understudy::cli {

void add_watch_options(CLI::App& command, WatchOptions& options, const std::string& what) {
  auto* watch = command.add_flag("--watch", options.watch,
                                 "serve " + what + " to a browser of this computer (docs/watch.md)");
  command.add_option("--watch-port", options.port, "port of --watch; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->needs(watch)
      ->capture_default_str();
}

}  // namespace understudy::cli
