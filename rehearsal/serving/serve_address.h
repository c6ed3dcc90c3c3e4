// Where a served twin listens: tcp:HOST:PORT or pty:PATH.
#pragma once

#include <string>

namespace understudy::rehearsal {

struct ServeAddress {
  std::string host;  ///< of TCP; empty: a pseudo-terminal
  int port = 0;      ///< 0: any free one
  std::string path;  ///< of the link to the pseudo-terminal
  bool is_tcp() const { return path.empty(); }
};

/// Throws InputError for words that are no address, a port out of range, and, unless `network`, for a host
/// that is not this one (127.0.0.0/8, ::1, localhost).
ServeAddress parse_serve_address(const std::string& words, bool network);

}  // namespace understudy::rehearsal
