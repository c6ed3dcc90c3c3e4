#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "drivers/gcode/descriptor_link.h"

namespace understudy::drivers {
namespace {

constexpr int kConnectTime = 5000;  // [ms]

std::string why(int error) { return std::generic_category().message(error); }

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
    return std::make_unique<DescriptorLink>(std::move(socket), DescriptorLink::Kind::socket, uri.place);
  }
  throw MachineError(fmt::format("{}: nobody answers: {}", uri.text, why(error)));
}

}  // namespace understudy::drivers
