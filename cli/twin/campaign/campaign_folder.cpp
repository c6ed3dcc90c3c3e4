#include "cli/twin/campaign/campaign_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/file/staged_file.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLock = "campaign.lock";

std::string this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

}  // namespace

CampaignFolder::CampaignFolder(fs::path path, studies::StoreHeader header)
    : path_(path.has_filename() ? std::move(path) : path.parent_path()), header_(std::move(header)) {}

void CampaignFolder::refuse(const std::string& why) const {
  throw InputError(fmt::format("{}: {}", path_.string(), why));
}

void CampaignFolder::take(bool resume) {
  std::error_code error;
  const bool begun = fs::exists(store(), error);
  if (fs::exists(path_, error) && !fs::is_directory(path_, error)) refuse("is a file: name a folder");
  if (!begun && fs::is_directory(path_, error))
    for (const auto& entry : fs::directory_iterator(path_, error))
      if (const std::string name = entry.path().filename().string(); name != kLock && name != "parts")
        refuse(fmt::format("holds {}, which no campaign wrote: name another folder", name));
  fs::create_directories(path_ / "parts", error);
  if (error) refuse("cannot be made: " + error.message());
  const fs::path lock = path_ / kLock;
  lock_ = Descriptor(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (!lock_.is_open()) failed_to_write(lock, errno);
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
    refuse(fmt::format("another campaign is writing here ({}): wait for it, or name another folder",
                       read_file(lock)));
  const std::string me = this_process();
  if (::ftruncate(lock_.get(), 0) != 0 || ::write(lock_.get(), me.data(), me.size()) < 0)
    failed_to_write(lock, errno);
  if (begun && !resume) {
    check();
    refuse("holds runs of this campaign: --resume goes on with them; or name another folder");
  }
  studies::ResultStore(store(), header_, studies::StoreUse::merged);
}

void CampaignFolder::check() const {
  std::error_code ignored;
  if (!fs::exists(store(), ignored)) refuse("holds no campaign");
  static_cast<void>(studies::stored_runs(store(), header_));
}

std::vector<fs::path> CampaignFolder::parts() const {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path_ / "parts", ignored))
    if (entry.path().extension() == ".sqlite") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::uint64_t> CampaignFolder::missing(std::uint64_t end, const std::string& name_begins) const {
  std::set<std::uint64_t> known = studies::stored_runs(store(), header_);
  for (const fs::path& part : parts()) {
    if (!part.filename().string().starts_with(name_begins)) continue;
    if (studies::being_written(part)) continue;
    known.merge(studies::stored_runs(part, header_));
  }
  std::vector<std::uint64_t> all;
  for (std::uint64_t i = 0; i < end; ++i)
    if (!known.contains(i)) all.push_back(i);
  return all;
}

void CampaignFolder::merge(std::uint64_t end) {
  const std::set<std::uint64_t> known = studies::stored_runs(store(), header_);
  std::map<std::uint64_t, studies::RunRow> rows;
  std::vector<fs::path> taken;
  for (const fs::path& part : parts()) {
    if (studies::being_written(part))
      continue;  // of a worker that is believed dead: its runs were done again
    bool all = true;
    for (studies::RunRow& row : studies::read_rows(part, header_)) {
      if (row.index >= end)
        all = false;
      else if (!known.contains(row.index))
        rows.emplace(row.index, std::move(row));
    }
    if (all) taken.push_back(part);
  }
  std::vector<studies::RunRow> in_order;
  for (auto& [index, row] : rows) in_order.push_back(std::move(row));
  if (!in_order.empty()) studies::ResultStore(store(), header_, studies::StoreUse::merged).add_all(in_order);
  std::error_code ignored;
  for (const fs::path& part : taken)
    for (const char* file : {"", "-wal", "-shm"}) fs::remove(part.string() + file, ignored);
}

std::vector<studies::RunRow> CampaignFolder::rows(std::uint64_t begin, std::uint64_t end) const {
  return studies::read_rows(store(), header_, begin, end);
}

}  // namespace understudy::cli
