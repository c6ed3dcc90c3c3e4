// Serves one page that grows to browsers of this computer: HTTP on 127.0.0.1, changes by server-sent events.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace understudy::cli {

/// What is served now. Called on the server's threads while it lives.
struct LiveContent {
  std::function<std::string()> page;      ///< HTML, at /
  std::function<std::string()> record;    ///< JSON, at /record.json
  std::function<std::string()> progress;  ///< JSON in one line, of the events at /events
};

class LiveServer {
 public:
  /// `port` 0: any free one. Throws InputError where the port cannot be had.
  LiveServer(LiveContent content, int port);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  std::string url() const;  ///< "http://127.0.0.1:8000/"

  /// From now on / is `page`. Browsers that watch are told, and waited for until they have it, 5 s at most.
  void finish(std::string page);
  /// The same of a run without a finished page: the one that is there stays, and says `words`, which
  /// have neither quotes nor backslashes.
  void end(const std::string& words);

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

/// Of cpp-httplib, as it is loaded: "0.11.4".
std::string loaded_httplib();

}  // namespace understudy::cli
