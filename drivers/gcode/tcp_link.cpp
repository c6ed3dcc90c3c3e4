#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/descriptor.h"
#include "drivers/gcode/byte_link.h"

namespace understudy::drivers {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kConnectTime = 5000;  // [ms]

std::string why(int error) { return std::generic_category().message(error); }

class TcpLink : public ByteLink {
 public:
  TcpLink(Descriptor socket, std::string peer) : socket_(std::move(socket)), peer_(std::move(peer)) {}

  double now() const override { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  std::size_t send(std::string_view bytes) override {
    const ssize_t n = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return 0;
    throw gone(why(errno));
  }
  std::size_t receive(std::span<char> bytes) override {
    const ssize_t n = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (n > 0) return static_cast<std::size_t>(n);
    if (n == 0) throw gone("it hung up");
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return 0;
    throw gone(why(errno));
  }
  void wait(double until) override {
    const double left = until - now();
    if (left <= 0) return;
    if (left < 1e-3) return std::this_thread::sleep_for(std::chrono::duration<double>(left));
    pollfd readable{socket_.get(), POLLIN, 0};
    ::poll(&readable, 1, static_cast<int>(left * 1e3));
  }

 private:
  MachineError gone(const std::string& reason) const {
    return MachineError(fmt::format("{} is gone: {}", peer_, reason));
  }

  Descriptor socket_;
  std::string peer_;
  Clock::time_point begin_ = Clock::now();
};

/// 0, or the error.
int connect_within(int socket, const addrinfo& address) {
  ::fcntl(socket, F_SETFL, O_NONBLOCK);
  if (::connect(socket, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd writable{socket, POLLOUT, 0};
  if (::poll(&writable, 1, kConnectTime) == 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

}  // namespace

std::unique_ptr<ByteLink> open_tcp_link(const PortUri& uri) {
  const auto colon = uri.place.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == uri.place.size())
    throw InputError(uri.text + ": write tcp://host:port");
  const std::string host = uri.place.substr(0, colon), port = uri.place.substr(colon + 1);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0)
    throw MachineError(fmt::format("{}: {}: {}", uri.text, host, ::gai_strerror(error)));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  int error = 0;
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
    Descriptor socket(::socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    error = socket.is_open() ? connect_within(socket.get(), *address) : errno;
    if (error != 0) continue;
    const int on = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    return std::make_unique<TcpLink>(std::move(socket), uri.place);
  }
  throw MachineError(fmt::format("{}: nobody answers: {}", uri.text, why(error)));
}

}  // namespace understudy::drivers
