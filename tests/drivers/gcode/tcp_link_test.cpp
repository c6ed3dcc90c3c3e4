#include <netinet/in.h>
#include <sys/socket.h>

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/descriptor.h"
#include "drivers/gcode/byte_link.h"

namespace understudy::drivers {
namespace {

/// A listener on a free port of this computer.
struct Listener {
  Descriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  int port = 0;

  Listener() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size) == 0 &&
        ::listen(socket.get(), 1) == 0 &&
        ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) == 0)
      port = ntohs(address.sin_port);
  }
  PortUri uri() const { return parse_port_uri("tcp://127.0.0.1:" + std::to_string(port)); }
};

TEST(TcpLink, CarriesBytesBothWaysAndSaysWhenThePeerHangsUp) {
  Listener listener;
  ASSERT_GT(listener.port, 0);
  const auto link = open_tcp_link(listener.uri());
  Descriptor peer(::accept(listener.socket.get(), nullptr, nullptr));
  char bytes[16];
  EXPECT_EQ(link->receive(bytes), 0U);
  EXPECT_EQ(link->send("M115\n"), 5U);
  EXPECT_EQ(::recv(peer.get(), bytes, sizeof(bytes), 0), 5);
  ASSERT_EQ(::send(peer.get(), "ok\n", 3, 0), 3);
  link->wait(link->now() + 5);
  EXPECT_EQ(link->receive(bytes), 3U);
  peer.close();
  link->wait(link->now() + 5);
  EXPECT_THROW(link->receive(bytes), MachineError);
}

TEST(TcpLink, WaitsNoLongerThanItIsAsked) {
  Listener listener;
  const auto link = open_tcp_link(listener.uri());
  const double begin = link->now();
  link->wait(begin + 0.05);
  EXPECT_GE(link->now() - begin, 0.049);
}

TEST(TcpLink, NobodyAnswersAndWrongAddresses) {
  int port = 0;
  {
    const Listener gone;
    port = gone.port;
  }
  EXPECT_THROW(open_tcp_link(parse_port_uri("tcp://127.0.0.1:" + std::to_string(port))), MachineError);
  EXPECT_THROW(open_tcp_link(parse_port_uri("tcp://127.0.0.1")), InputError);
  EXPECT_THROW(open_tcp_link(parse_port_uri("tcp://:23")), InputError);
}

}  // namespace
}  // namespace understudy::drivers
