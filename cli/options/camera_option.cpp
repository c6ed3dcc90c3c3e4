#include "cli/options/camera_option.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/file/is_file.h"
#include "vision/formats/formats.h"
#include "vision/picture/picture_file.h"

namespace understudy::cli {
namespace {

namespace fs = std::filesystem;
using drivers::TimedImage;

constexpr vision::NetworkLimits kNetwork{.open = 5, .read = 2};  // [s]
constexpr double kStampSane = 2.0;  // [s], age of a driver's stamp that is believed

Image grey(const cv::Mat& picture) {
  cv::Mat one;
  if (picture.channels() == 1)
    one = picture;
  else
    cv::cvtColor(picture, one, cv::COLOR_BGR2GRAY);
  Image image;
  image.region = {0, 0, one.cols, one.rows};
  for (int y = 0; y < one.rows; ++y)
    image.pixels.insert(image.pixels.end(), one.ptr<std::uint8_t>(y), one.ptr<std::uint8_t>(y) + one.cols);
  return image;
}

class FolderSource : public drivers::FrameSource {
 public:
  /// What lies there already was exposed before anything was asked.
  explicit FolderSource(fs::path folder) : folder_(std::move(folder)) {
    for (const fs::path& file : pictures()) seen_.insert(file.filename().string());
  }

  std::optional<TimedImage> newest() override {
    std::vector<std::pair<double, fs::path>> unseen;
    for (const fs::path& picture : pictures())
      if (!seen_.contains(picture.filename().string())) unseen.emplace_back(stamp_of(picture), picture);
    const auto last = std::ranges::max_element(unseen);
    if (last == unseen.end()) return std::nullopt;
    TimedImage newest{{}, last->first, 0};
    try {
      newest.image = vision::read_picture(last->second.string());
    } catch (const InputError&) {
      return std::nullopt;  // half written: it is looked at again
    }
    for (const auto& [stamp, picture] : unseen) seen_.insert(picture.filename().string());
    newest.number = seen_.size();
    return newest;
  }
  std::string ended() const override {
    return is_folder(folder_) ? "" : folder_.string() + ": the folder is gone";
  }

 private:
  std::vector<fs::path> pictures() const {
    static const std::set<std::string> kKinds{".png", ".jpg", ".jpeg", ".pgm", ".bmp", ".tif", ".tiff"};
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
      if (kKinds.contains(entry->path().extension().string())) found.push_back(entry->path());
    return found;
  }
  static double stamp_of(const fs::path& file) {
    const std::string name = file.stem().string();
    double seconds = 0;
    const auto [end, bad] = std::from_chars(name.data(), name.data() + name.size(), seconds);
    if (bad == std::errc() && end == name.data() + name.size() && seconds > 1e9) return seconds;
    std::error_code error;
    const auto written = fs::last_write_time(file, error);
    if (error) return 0;
    return std::chrono::duration<double>(std::chrono::file_clock::to_sys(written).time_since_epoch()).count();
  }

  fs::path folder_;
  std::set<std::string> seen_;
};

/// Reads in a thread of its own, so that the newest frame is at hand and none waits in a buffer.
class VideoSource : public drivers::FrameSource {
 public:
  VideoSource(const std::string& word, std::unique_ptr<vision::VideoReader> video, bool stamped)
      : word_(word), video_(std::move(video)), stamped_(stamped) {
    if (!video_) throw InputError(fmt::format("--camera {}: no camera answers there", word));
    thread_ = std::thread([this] { read(); });
  }
  ~VideoSource() override {
    stop_ = true;
    thread_.join();
  }
  std::optional<TimedImage> newest() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(newest_, std::nullopt);
  }
  std::string ended() const override { return ended_ ? word_ + ": the camera delivers no more" : ""; }

 private:
  void read() {
    cv::Mat picture;
    for (std::uint64_t number = 0; !stop_; ++number) {
      if (!video_->read(picture)) break;
      const double came = drivers::wall_clock();
      double age = 0;
      if (stamped_) {
        const double steady =
            std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
        age = steady - video_->position();
        if (!(age >= 0 && age < kStampSane)) age = 0;
      }
      TimedImage image{grey(picture), came - age, number};
      const std::lock_guard lock(mutex_);
      newest_ = std::move(image);
    }
    ended_ = true;
  }

  std::string word_;
  std::unique_ptr<vision::VideoReader> video_;
  bool stamped_;  // frames carry the time at which they were exposed
  std::mutex mutex_;
  std::optional<TimedImage> newest_;
  std::atomic<bool> stop_ = false, ended_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<drivers::FrameSource> open_camera(const std::string& word) {
  const auto after = [&](const char* begin) {
    return word.starts_with(begin) ? word.substr(std::string(begin).size()) : std::string();
  };
  if (const std::string folder = after("folder:"); !folder.empty()) {
    if (!is_folder(folder)) throw InputError(fmt::format("--camera {}: no such folder", word));
    return std::make_unique<FolderSource>(folder);
  }
  if (const std::string device = after("v4l2:"); !device.empty()) {
    if (!is_there(device)) throw InputError(fmt::format("--camera {}: no such device", word));
    return std::make_unique<VideoSource>(word, vision::formats().open_device(device), true);
  }
  if (word.starts_with("http://") || word.starts_with("https://"))
    return std::make_unique<VideoSource>(word, vision::formats().open_network(word, kNetwork), false);
  throw InputError(fmt::format("--camera {}: one of folder:DIR, v4l2:/dev/videoN, http://...", word));
}

}  // namespace understudy::cli
