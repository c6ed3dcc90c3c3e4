#include "core/partial_results.h"

#include <mutex>
#include <set>
#include <system_error>
#include <utility>

namespace understudy {
namespace {

/// Never destroyed: a thread may outlive the static objects.
struct Registry {
  std::mutex mutex;
  std::multiset<std::filesystem::path> paths;
};
Registry& registry() {
  static auto* const the = new Registry;
  return *the;
}

constexpr int kRounds = 20;

/// False where something came into it meanwhile, each time.
bool remove_in_rounds(const std::filesystem::path& path) {
  std::error_code ignored;
  for (int round = 0; round < kRounds; ++round) {
    std::filesystem::remove_all(path, ignored);
    if (!std::filesystem::exists(std::filesystem::symlink_status(path, ignored))) return true;
  }
  return false;
}

/// Other threads may still write into it when the process is ended. Those that are faster than its removal do
/// not find it by another name.
void take_away(const std::filesystem::path& path) {
  if (remove_in_rounds(path)) return;
  const std::filesystem::path aside = path.string() + ".removed";
  std::error_code failed;
  std::filesystem::rename(path, aside, failed);
  static_cast<void>(remove_in_rounds(failed ? path : aside));
}

}  // namespace

PartialResult::PartialResult(std::filesystem::path path) : path_(std::move(path)) {
  const std::scoped_lock lock(registry().mutex);
  registry().paths.insert(path_);
}

PartialResult::~PartialResult() {
  const std::scoped_lock lock(registry().mutex);
  if (keep_) return;
  registry().paths.erase(registry().paths.find(path_));
  take_away(path_);
}

void PartialResult::keep() {
  keep_after([] {});
}

void PartialResult::keep_after(const std::function<void()>& last) {
  const std::scoped_lock lock(registry().mutex);
  if (!std::exchange(keep_, true)) registry().paths.erase(registry().paths.find(path_));
  last();
}

void remove_partial_results() {
  registry().mutex.lock();  // for good
  for (const auto& path : registry().paths) take_away(path);
}

}  // namespace understudy
