#include "rehearsal/serving/serve_line.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/descriptor.h"

namespace understudy::rehearsal {
namespace {

constexpr int kSlowClient = 2000;  // [ms]
constexpr int kLastWords = 500;    // [ms], at most, that a sender has to read the last answer
constexpr int kLook = 10;          // [ms], between two looks whether it has
constexpr std::size_t kChunk = 4096;

bool ready(int file, short what, int milliseconds) {
  pollfd look{file, what, 0};
  return ::poll(&look, 1, milliseconds) > 0 && (look.revents & what) != 0;
}

/// What both lines do with an open file.
class OpenLine {
 public:
  /// Nothing where none has come. Sets `gone` where the other side has closed.
  static std::string read(int file, std::size_t room, int milliseconds, bool& gone) {
    std::string bytes(std::min(room, kChunk), '\0');
    if (bytes.empty()) {
      ::poll(nullptr, 0, milliseconds);
      return {};
    }
    if (!ready(file, POLLIN, milliseconds)) return {};
    const ssize_t count = ::read(file, bytes.data(), bytes.size());
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) gone = true;
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  static void write(int file, std::string_view bytes, bool& gone) {
    while (!bytes.empty() && !gone) {
      if (!ready(file, POLLOUT, kSlowClient)) {
        gone = true;
        return;
      }
      const ssize_t count = ::write(file, bytes.data(), bytes.size());
      if (count < 0 && errno != EAGAIN && errno != EINTR) gone = true;
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }
};

class TcpLine final : public ServeLine {
 public:
  explicit TcpLine(const ServeAddress& address) : address_(address) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    const std::string port = std::to_string(address.port);
    if (const int error = ::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found); error != 0)
      throw InputError(
          fmt::format("--port tcp:{}:{}: {}", address.host, address.port, ::gai_strerror(error)));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
    listener_ = Descriptor(::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int yes = 1;
    ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (listener_.get() < 0 || ::bind(listener_.get(), found->ai_addr, found->ai_addrlen) != 0 ||
        ::listen(listener_.get(), 4) != 0)
      throw InputError(fmt::format("--port tcp:{}:{}: {}", address.host, address.port, std::strerror(errno)));
    sockaddr_storage bound{};
    socklen_t size = sizeof bound;
    if (::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&bound), &size) == 0)
      address_.port = ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6*>(&bound)->sin6_port
                                                        : reinterpret_cast<sockaddr_in*>(&bound)->sin_port);
  }

  std::string name() const override { return fmt::format("tcp:{}:{}", address_.host, address_.port); }

  bool connected() override {
    if (gone_) client_ = Descriptor();
    if (ready(listener_.get(), POLLIN, 0)) {
      Descriptor next(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (client_.get() < 0 && next.get() >= 0) {
        client_ = std::move(next);
        gone_ = false;
      } else if (next.get() >= 0) {
        bool ignored = false;
        OpenLine::write(next.get(), "[MSG:busy: one sender at a time]\r\n", ignored);
      }
    }
    return client_.get() >= 0;
  }

  std::string read(std::size_t room, int milliseconds) override {
    return OpenLine::read(client_.get(), room, milliseconds, gone_);
  }
  void write(std::string_view bytes) override { OpenLine::write(client_.get(), bytes, gone_); }

 private:
  ServeAddress address_;
  Descriptor listener_, client_;
  bool gone_ = true;
};

class PtyLine final : public ServeLine {
 public:
  explicit PtyLine(const ServeAddress& address) : link_(address.path) {
    master_ = Descriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
    char name[128] = "";
    if (master_.get() < 0 || ::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0 ||
        ::ptsname_r(master_.get(), name, sizeof name) != 0)
      throw MachineError(fmt::format("no pseudo-terminal can be opened: {}", std::strerror(errno)));
    slave_ = name;
    set_raw();
    std::error_code error;
    if (std::filesystem::is_symlink(link_, error) && !std::filesystem::exists(link_, error))
      std::filesystem::remove(link_, error);  // of a server that was killed
    std::filesystem::create_symlink(slave_, link_, error);
    if (error) throw InputError(fmt::format("--port pty:{}: {}", address.path, error.message()));
  }
  ~PtyLine() override {
    let_read();
    std::error_code ignored;
    std::filesystem::remove(link_, ignored);
  }
  PtyLine(const PtyLine&) = delete;
  PtyLine& operator=(const PtyLine&) = delete;

  std::string name() const override { return fmt::format("{} ({})", link_.string(), slave_); }

  /// A master hangs up while nobody has the other end open.
  bool connected() override {
    pollfd look{master_.get(), POLLIN, 0};
    ::poll(&look, 1, 0);
    const bool open = (look.revents & POLLHUP) == 0;
    return open || (look.revents & POLLIN) != 0;
  }
  std::string read(std::size_t room, int milliseconds) override {
    bool ignored = false;
    return OpenLine::read(master_.get(), room, milliseconds, ignored);
  }
  void write(std::string_view bytes) override {
    bool gone = !connected();
    OpenLine::write(master_.get(), bytes, gone);
  }

 private:
  /// As a terminal hangs up, what its reader has not fetched is lost.
  void let_read() {
    if (!connected()) return;
    const Descriptor end(::open(slave_.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    int waiting = 1;
    for (int waited = 0; end.is_open() && waiting > 0 && waited < kLastWords; waited += kLook) {
      ::poll(nullptr, 0, kLook);  // the kernel passes on what was written a moment later
      if (::ioctl(end.get(), FIONREAD, &waiting) != 0) return;
    }
  }

  /// As a serial port without echo and without meaning in its characters; Ctrl-X and ! are data.
  void set_raw() const {
    const Descriptor slave(::open(slave_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios how{};
    if (slave.get() < 0 || ::tcgetattr(slave.get(), &how) != 0) return;
    ::cfmakeraw(&how);
    ::tcsetattr(slave.get(), TCSANOW, &how);
  }

  std::filesystem::path link_;
  std::string slave_;
  Descriptor master_;
};

}  // namespace

std::unique_ptr<ServeLine> open_serve_line(const ServeAddress& address) {
  if (address.is_tcp()) return std::make_unique<TcpLine>(address);
  return std::make_unique<PtyLine>(address);
}

}  // namespace understudy::rehearsal
