#include "cli/watch/live_server.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "core/error.h"
#include "core/library_versions.h"

namespace understudy::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenEvents = 500ms;
constexpr auto kLastPage = 5s;  // that a browser has to load it
// Each browser holds one for its events and needs others for its pages.
constexpr std::size_t kThreads = 16;
constexpr int kViewers = 8;

// The library's own options let a second server take the same port.
void only_one(socket_t socket) {
  const int yes = 1;
  static_cast<void>(::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes));
}

std::string event_of(const char* name, const std::string& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, data);
}

}  // namespace

std::string loaded_httplib() { return loaded_version("libcpp-httplib", CPPHTTPLIB_VERSION); }

struct LiveServer::Server {
  explicit Server(LiveContent served) : content(std::move(served)) {}

  void route();
  std::string page();
  void stream(const httplib::Request& request, httplib::Response& response);
  bool send_event(httplib::DataSink& sink, std::string& sent);
  bool of_this_computer(const httplib::Request& request) const;

  LiveContent content;
  httplib::Server http;
  int port = 0;
  std::thread thread;

  std::mutex mutex;
  std::condition_variable changed;
  std::string last_page, last_words;  ///< guarded by `mutex`, as all below
  bool finished = false, ended = false, closing = false;
  int viewers = 0, late = 0;  ///< that have yet to load the last page
};

// Another site's script may not read this page under a name of its own that leads to 127.0.0.1.
bool LiveServer::Server::of_this_computer(const httplib::Request& request) const {
  const std::string host = request.get_header_value("Host");
  return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
}

std::string LiveServer::Server::page() {
  {
    const std::scoped_lock lock(mutex);
    if (finished) {
      if (late > 0) --late;
      changed.notify_all();
      return last_page;
    }
  }
  return content.page();
}

bool LiveServer::Server::send_event(httplib::DataSink& sink, std::string& sent) {
  std::string last;
  {
    std::unique_lock lock(mutex);
    const auto over = [this] { return finished || ended || closing; };
    if (!sent.empty()) changed.wait_for(lock, kBetweenEvents, over);
    if (over())
      last = finished ? event_of("done", "{}")
             : ended  ? event_of("ended", last_words)
                      : event_of("stopped", "{}");
  }
  std::string event = last.empty() ? event_of("grown", content.progress()) : last;
  // A comment keeps the line alive where nothing has changed, and shows when the browser has left.
  if (event == sent)
    event = ": no change\n\n";
  else
    sent = event;
  if (!sink.write(event.data(), event.size())) return false;
  if (last.empty()) return true;
  sink.done();
  const std::scoped_lock lock(mutex);
  if (ended && late > 0) --late;
  changed.notify_all();
  return true;
}

void LiveServer::Server::stream(const httplib::Request&, httplib::Response& response) {
  {
    const std::scoped_lock lock(mutex);
    if (viewers >= kViewers) {
      response.status = 503;
      response.set_content(fmt::format("{} browsers watch already", kViewers), "text/plain");
      return;
    }
    ++viewers;
  }
  response.set_header("Cache-Control", "no-store");
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, sent = std::string()](std::size_t, httplib::DataSink& sink) mutable {
        return send_event(sink, sent);
      },
      [this](bool) {
        const std::scoped_lock lock(mutex);
        --viewers;
      });
}

void LiveServer::Server::route() {
  http.set_socket_options(only_one);
  http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    // A body would be read whole, however large; any page may send one here.
    const bool reads = request.method == "GET" || request.method == "HEAD";
    if (reads && of_this_computer(request)) return httplib::Server::HandlerResponse::Unhandled;
    response.status = reads ? 403 : 405;
    return httplib::Server::HandlerResponse::Handled;
  });
  http.Get("/", [this](const httplib::Request&, httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_content(page(), "text/html; charset=utf-8");
  });
  http.Get("/record.json", [this](const httplib::Request&, httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_content(content.record(), "application/json");
  });
  http.Get("/favicon.ico",
           [](const httplib::Request&, httplib::Response& response) { response.status = 204; });
  http.Get("/events", [this](const httplib::Request& request, httplib::Response& response) {
    stream(request, response);
  });
}

LiveServer::LiveServer(LiveContent content, int port)
    : server_(std::make_unique<Server>(std::move(content))) {
  server_->route();
  const char* loopback = "127.0.0.1";
  server_->port = port > 0 && server_->http.bind_to_port(loopback, port) ? port
                  : port > 0                                             ? -1
                             : server_->http.bind_to_any_port(loopback);
  if (server_->port <= 0)
    throw InputError(
        fmt::format("--watch-port {}: the port is in use or not allowed; 0 takes any free one", port));
  server_->thread = std::thread([this] { server_->http.listen_after_bind(); });
}

std::string LiveServer::url() const { return fmt::format("http://127.0.0.1:{}/", server_->port); }

void LiveServer::finish(std::string page) {
  std::unique_lock lock(server_->mutex);
  if (server_->finished) return;
  server_->last_page = std::move(page);
  server_->late = server_->viewers;
  server_->finished = true;
  server_->changed.notify_all();
  server_->changed.wait_for(lock, kLastPage, [this] { return server_->late == 0; });
}

void LiveServer::end(const std::string& words) {
  std::unique_lock lock(server_->mutex);
  server_->last_words = fmt::format(R"({{"what":"{}"}})", words);
  server_->late = server_->viewers;
  server_->ended = true;
  server_->changed.notify_all();
  server_->changed.wait_for(lock, kLastPage, [this] { return server_->late == 0; });
}

LiveServer::~LiveServer() {
  {
    const std::scoped_lock lock(server_->mutex);
    server_->closing = true;
    server_->changed.notify_all();
  }
  server_->http.stop();
  if (server_->thread.joinable()) server_->thread.join();
}

}  // namespace understudy::cli
