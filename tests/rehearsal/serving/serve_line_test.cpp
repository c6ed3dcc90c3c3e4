#include "rehearsal/serving/serve_line.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "core/file/descriptor.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

TEST(PtyLine, ASenderThatIsSlowStillReadsTheLastAnswer) {
  const TemporaryFolder folder;
  const ServeAddress address = parse_serve_address("pty:" + (folder / "twin").string(), false);
  auto line = open_serve_line(address);
  const Descriptor sender(::open((folder / "twin").c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  ASSERT_TRUE(sender.is_open());
  line->write("ok\n");
  std::thread ends([&] { line.reset(); });
  ::poll(nullptr, 0, 150);  // [ms]
  std::array<char, 16> bytes{};
  EXPECT_EQ(::read(sender.get(), bytes.data(), bytes.size()), 3);
  EXPECT_EQ(std::string(bytes.data()), "ok\n");
  ends.join();
}

}  // namespace
}  // namespace understudy::rehearsal
