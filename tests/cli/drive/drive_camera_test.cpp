// `drive --camera`: pictures of a camera that is not the machine's own: a folder that grows, an HTTP stream.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "core/file/read_file.h"
#include "machine/record/record_reader.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kFrame{30};

/// Repeats something every 30 ms until the test is over.
class Stream {
 public:
  template <typename Send>
  explicit Stream(Send send)
      : thread_([this, send] {
          while (!over_ && send()) std::this_thread::sleep_for(kFrame);
        }) {}
  ~Stream() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// One client at a time gets the picture again and again, as multipart/x-mixed-replace.
class MjpegServer {
 public:
  explicit MjpegServer(const std::string& jpeg) : socket_(::socket(AF_INET, SOCK_STREAM, 0)), jpeg_(jpeg) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(socket_, 4) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      ADD_FAILURE() << "no socket on this computer";
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~MjpegServer() {
    over_ = true;
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
    thread_.join();
  }
  std::string url() const { return fmt::format("http://127.0.0.1:{}/stream.mjpg", port_); }

 private:
  static bool send(int client, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const auto n = ::send(client, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  void serve() {
    while (!over_) {
      const int client = ::accept(socket_, nullptr, nullptr);
      if (client < 0) return;
      char request[4096];
      static_cast<void>(::recv(client, request, sizeof(request), 0));
      bool well =
          send(client, "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n");
      while (well && !over_) {
        well = send(client, fmt::format("--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                                        jpeg_.size()) +
                                jpeg_ + "\r\n");
        std::this_thread::sleep_for(kFrame);
      }
      ::close(client);
    }
  }

  int socket_, port_ = 0;
  std::string jpeg_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

std::vector<machine::Frame> frames_of(const std::string& record) {
  std::vector<machine::Frame> frames;
  machine::read_record(record, [&](const machine::RecordedEntry& entry) {
    const auto* frame = std::get_if<machine::RecordedFrame>(&entry);
    if (frame && frame->answer == machine::Status::ok) frames.push_back(frame->frame);
  });
  return frames;
}

class DriveCamera : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome drawn = understudy("render laser -o " + (own_ / "dot.png"));
    ASSERT_EQ(drawn.status, 0) << drawn.err;
  }
  std::string drive(const std::string& camera) const {
    return "drive " + kSource +
           "/scenarios/song-bottle.gcode --fixture bottle --gap-control start --without-rehearsal --port "
           "loopback:// --camera " +
           camera + " --record " + (own_ / "d.record");
  }
  /// The picture is that of the dot at the aim, always: each approach ends with its first frames.
  void expect_seen(const Outcome& outcome) const {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("frames used"));
    EXPECT_THAT(outcome.out, HasSubstr("gap loop, exposure to setpoints queued: median"));
    EXPECT_THAT(outcome.out, HasSubstr("camera    good")) << outcome.err;
    const std::vector<machine::Frame> frames = frames_of(own_ / "d.record");
    ASSERT_GE(frames.size(), 2U) << outcome.err;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_LE(frames[i].exposed_at, frames[i].received_at);
      EXPECT_LT(frames[i].received_at - frames[i].exposed_at, 0.5);  // of a busy computer
      EXPECT_TRUE(i == 0 || frames[i].number > frames[i - 1].number) << "no picture is given twice";
    }
  }
  Folder own_;
};

TEST_F(DriveCamera, SeesByAFolderThatGrows) {
  const fs::path folder = own_ / "frames";
  fs::create_directory(folder);
  const std::string png = read_file(own_ / "dot.png");
  int old = 0;
  const Stream stream([&] {
    const double now =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    own_.write("writing", png);
    std::error_code error;
    fs::rename(own_ / "writing", folder / fmt::format("{:.6f}.png", now), error);
    own_.write(fmt::format("frames/notes{}.txt", ++old), "no picture");
    return !error;
  });
  expect_seen(understudy(drive("folder:" + folder.string())));
}

TEST_F(DriveCamera, SeesByAnHttpStream) {
  std::vector<unsigned char> jpeg;
  ASSERT_TRUE(cv::imencode(".jpg", cv::imread(own_ / "dot.png", cv::IMREAD_GRAYSCALE), jpeg));
  const MjpegServer server(std::string(jpeg.begin(), jpeg.end()));
  expect_seen(understudy(drive(server.url())));
}

TEST_F(DriveCamera, ACameraThatIsNotThereIsOneLineAndNothingIsWritten) {
  const auto refused = [&](const std::string& camera, const std::string& why) {
    const Outcome outcome = understudy(drive(camera));
    EXPECT_EQ(outcome.status, 2) << camera;
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(own_ / "d.record"));
  };
  refused("folder:" + (own_ / "none"), "no such folder");
  refused("v4l2:/dev/video99", "no such device");
  refused("v4l2:" + (own_ / "dot.png"), "no camera answers there");
  refused("http://127.0.0.1:1/", "no camera answers there");
  refused("carrier-pigeon", "one of folder:DIR");
}

}  // namespace
}  // namespace understudy::cli_test
