// `--watch` and `--watch-port`: a page that browsers of this computer look at while a command goes on.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace understudy::cli {

struct WatchOptions {
  bool watch = false;
  int port = 0;  ///< 0: any free one
};

/// `what` the page is: "the growing report". `options` must outlive `command`.
void add_watch_options(CLI::App& command, WatchOptions& options, const std::string& what);

}  // namespace understudy::cli
