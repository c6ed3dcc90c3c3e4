#include "drivers/gcode/descriptor_link.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::drivers {
namespace {

bool only_later(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

MachineError gone(const std::string& peer, const std::string& why) {
  return MachineError(fmt::format("{} is gone: {}", peer, why));
}

std::string text_of(int error) { return std::generic_category().message(error); }

}  // namespace

double DescriptorLink::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

std::size_t DescriptorLink::send(std::string_view bytes) {
  const ssize_t n = kind_ == Kind::socket ? ::send(file_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                          : ::write(file_.get(), bytes.data(), bytes.size());
  if (n >= 0) return static_cast<std::size_t>(n);
  if (only_later(errno)) return 0;
  throw gone(peer_, text_of(errno));
}

std::size_t DescriptorLink::receive(std::span<char> bytes) {
  const ssize_t n = ::read(file_.get(), bytes.data(), bytes.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n == 0) throw gone(peer_, "it hung up");
  if (only_later(errno)) return 0;
  throw gone(peer_, text_of(errno));
}

void DescriptorLink::wait(double until) {
  const double left = until - now();
  if (left <= 0) return;
  if (left < 1e-3) return std::this_thread::sleep_for(std::chrono::duration<double>(left));
  pollfd readable{file_.get(), POLLIN, 0};
  ::poll(&readable, 1, static_cast<int>(left * 1e3));
}

}  // namespace understudy::drivers
