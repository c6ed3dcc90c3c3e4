#include "cli/watch/watched_run.h"

#include <cstdio>

#include <fmt/format.h>

namespace understudy::cli {

WatchedRun::WatchedRun(int port)
    : server({[this] { return record.page(); }, [this] { return record.json(); },
              [this] { return record.progress_json(); }},
             port) {
  fmt::print(stderr, "watch: {}\n", server.url());
}

}  // namespace understudy::cli
