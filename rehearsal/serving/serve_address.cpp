#include "rehearsal/serving/serve_address.h"

#include <arpa/inet.h>

#include <charconv>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::rehearsal {
namespace {

constexpr const char* kForms = "tcp:HOST:PORT, such as tcp:127.0.0.1:2323, or pty:PATH";
constexpr int kLargestPort = 65535;

bool is_loopback(const std::string& host) {
  if (host == "localhost") return true;
  in_addr four{};
  if (::inet_pton(AF_INET, host.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
  in6_addr six{};
  return ::inet_pton(AF_INET6, host.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

}  // namespace

ServeAddress parse_serve_address(const std::string& words, bool network) {
  ServeAddress address;
  if (words.starts_with("pty:")) {
    address.path = words.substr(4);
    if (address.path.empty()) throw InputError(fmt::format("--port {}: no path; {}", words, kForms));
    return address;
  }
  const auto colon = words.rfind(':');
  if (!words.starts_with("tcp:") || colon < 4)
    throw InputError(fmt::format("--port {}: needs {}", words, kForms));
  address.host = words.substr(4, colon - 4);
  if (address.host.starts_with("[") && address.host.ends_with("]"))
    address.host = address.host.substr(1, address.host.size() - 2);
  const std::string port = words.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc() || end != port.data() + port.size() || address.port < 0 ||
      address.port > kLargestPort)
    throw InputError(
        fmt::format("--port {}: '{}' is no port; one of 0 (any free one) to {}", words, port, kLargestPort));
  if (address.host.empty()) throw InputError(fmt::format("--port {}: no host; {}", words, kForms));
  if (!network && !is_loopback(address.host))
    throw InputError(
        fmt::format("--port {}: {} is not this computer (127.0.0.1, ::1, localhost), and whoever reaches "
                    "the port may print; --network allows it",
                    words, address.host));
  return address;
}

}  // namespace understudy::rehearsal
