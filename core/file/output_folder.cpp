#include "core/file/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/is_file.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/file/staged_file.h"

namespace understudy {
namespace fs = std::filesystem;
namespace {

/// Tells that the folder TARGET.part is ours, to be taken away; in TARGET it tells nothing.
constexpr const char* kUnfinished = ".understudy-unfinished";
constexpr std::size_t kDigest = 64;  // hexadecimal digits

[[noreturn]] void refuse(const fs::path& target, const std::string& why) {
  throw InputError(fmt::format("cannot write {}: {}", target.string(), why));
}

std::string text_of(int error) { return std::generic_category().message(error); }

using Digests = std::map<std::string, std::string>;  // by name, relative to the folder

/// A manifest is a file like any other: what is changed in it must not reach beyond its folder.
bool leads_outside(const fs::path& name) {
  const fs::path inside = name.lexically_normal();
  return inside.is_absolute() || inside.empty() || *inside.begin() == "..";
}

Digests read_manifest(const fs::path& folder) {
  Digests digests;
  std::error_code ignored;
  if (!fs::is_regular_file(folder / kManifest, ignored)) return digests;
  std::istringstream lines(read_file(folder / kManifest));
  for (std::string line; std::getline(lines, line);)
    if (line.size() > kDigest + 2 && !leads_outside(line.substr(kDigest + 2)))
      digests[line.substr(kDigest + 2)] = line.substr(0, kDigest);
  return digests;
}

bool is_folder(const fs::directory_entry& entry) { return entry.is_directory() && !entry.is_symlink(); }

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!is_folder(entry) && entry.path() != folder / kUnfinished) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Of what we wrote: that it cannot be read (any more) is not the user's mistake.
std::string manifest_of(const fs::path& folder) {
  try {
    std::string text;
    for (const fs::path& file : files_in(folder))
      text += fmt::format("{}  {}\n", sha256_hex(read_file(file)), file.lexically_relative(folder).string());
    return text;
  } catch (const fs::filesystem_error& e) {
    failed_to_write(folder, e.code().value());
  } catch (const InputError& e) {
    throw MachineError(e.what());
  }
}

/// What a user has put into the folder of an older result, in words; empty: nothing.
std::string foreign_in(const fs::path& folder) {
  const Digests ours = read_manifest(folder);
  for (const fs::path& file : files_in(folder)) {
    const std::string name = file.lexically_relative(folder).string();
    if (name == kManifest && !ours.empty()) continue;
    const auto known = ours.find(name);
    if (known == ours.end()) return fmt::format("it holds {}, which no earlier run wrote", name);
    if (fs::is_symlink(file) || sha256_hex(read_file(file)) != known->second)
      return fmt::format("{} in it was changed since a run wrote it", name);
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string() + "/";
    const auto first = ours.lower_bound(name);
    if (is_folder(entry) && (first == ours.end() || !first->first.starts_with(name)))
      return fmt::format("it holds {}, which no earlier run wrote", name);
  }
  return "";
}

/// Made in one step: a process that is killed leaves the folder with the mark, or empty.
bool mark(const fs::path& folder) {
  const fs::path name = folder / kUnfinished;
  return Descriptor(::open(name.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666)).get() >= 0;
}

/// Empty: it does not exist, or an earlier run wrote all that is in it.
std::string why_not_replaceable(const fs::path& target) {
  try {
    const fs::file_status is = fs::symlink_status(target);
    if (!fs::exists(is)) return "";
    if (fs::is_symlink(is)) return "it is a link: name the folder that it leads to";
    if (!fs::is_directory(is)) return "it is a file";
    const std::string foreign = foreign_in(target);
    return foreign.empty() ? "" : foreign + ": move it, or name another folder";
  } catch (const fs::filesystem_error& e) {
    return e.code().message();
  } catch (const InputError& e) {
    return e.what();
  }
}

/// Inside `folder`, not itself.
void remove_empty_folders(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored))
    if (is_folder(entry)) folders.push_back(entry.path());
  std::sort(folders.rbegin(), folders.rend());
  for (const fs::path& inner : folders) fs::remove(inner, ignored);  // where it is empty
}

/// Removes what its manifest named, `ours`; whatever else has come into it stays, with the folders that it
/// lies in. The mark goes last: until then the next run removes what is left here.
void remove_result(const fs::path& folder, const Digests& ours) {
  std::error_code ignored;
  for (const auto& [name, digest] : ours) fs::remove(folder / name, ignored);
  fs::remove(folder / kManifest, ignored);
  remove_empty_folders(folder);
  fs::remove(folder / kUnfinished, ignored);
  fs::remove(folder, ignored);
}

/// Where the old result lies between the two steps of a replacement that cannot be one.
fs::path old_name(const fs::path& working) { return working.string() + ".old"; }

/// After a run that was killed between those, or after them.
void restore_old(const fs::path& working, const fs::path& target) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(target, ignored))) {
    if (fs::exists(old_name(working) / kUnfinished, ignored))
      remove_result(old_name(working), read_manifest(old_name(working)));
    return;
  }
  (void)::renameat2(AT_FDCWD, old_name(working).c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE);
}

/// The folder that was locked is not one that another run has renamed meanwhile.
bool is_still(const fs::path& path, const Descriptor& file) {
  struct stat named {
  }, opened{};
  return ::lstat(path.c_str(), &named) == 0 && ::fstat(file.get(), &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

/// In one step, so that the old result or the new one lies under the target's name; in two where the file
/// system cannot do that. errno, or 0.
int exchange(const fs::path& working, const fs::path& target) {
  const auto swap = [&](const char* from, const char* to, unsigned how) {
    return ::renameat2(AT_FDCWD, from, AT_FDCWD, to, how) == 0 ? 0 : errno;
  };
  const int failure = swap(working.c_str(), target.c_str(), RENAME_EXCHANGE);
  if (failure != EINVAL) return failure;
  const fs::path old = old_name(working);
  if (const int moved = swap(target.c_str(), old.c_str(), 0); moved != 0) return moved;
  if (const int moved = swap(working.c_str(), target.c_str(), 0); moved != 0) {
    std::rename(old.c_str(), target.c_str());
    return moved;
  }
  return swap(old.c_str(), working.c_str(), 0);
}

int move_new(const fs::path& working, const fs::path& target) {
  if (::renameat2(AT_FDCWD, working.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL) return errno;
  return std::rename(working.c_str(), target.c_str()) == 0 ? 0 : errno;
}

}  // namespace

std::string why_not_as_written(const fs::path& folder) {
  if (!is_folder(folder)) throw InputError(fmt::format("{} is no folder of results", folder.string()));
  const Digests ours = read_manifest(folder);
  if (ours.empty()) return fmt::format("it has no {}", kManifest);
  for (const auto& [name, digest] : ours)
    if (!is_file(folder / name)) return fmt::format("{} is missing", name);
  return foreign_in(folder);
}

bool is_as_written(const fs::path& folder, const std::string& name) {
  const Digests ours = read_manifest(folder);
  const auto known = ours.find(name);
  return known == ours.end() || sha256_hex(read_file(folder / name)) == known->second;
}

void check_replaceable(const fs::path& target) {
  if (const std::string why = why_not_replaceable(target); !why.empty()) refuse(target, why);
}

OutputFolder::OutputFolder(fs::path target) : target_(std::move(target)) {
  while (!target_.has_filename() && target_.has_parent_path() && target_ != target_.parent_path())
    target_ = target_.parent_path();
  if (target_.empty()) throw InputError("the output folder has no name");
  if (!target_.has_filename() || target_.filename() == "." || target_.filename() == "..")
    refuse(target_, "name a folder of its own");
  working_ = target_;
  working_ += ".part";
  lock();
  begin();
}

/// The lock is the folder itself: it ends with the process, however that dies.
void OutputFolder::lock() {
  std::error_code error;
  if (target_.has_parent_path()) fs::create_directories(target_.parent_path(), error);
  if (error) cannot_write(target_, error.value());
  do {
    if (::mkdir(working_.c_str(), 0777) != 0 && errno != EEXIST) cannot_write(target_, errno);
    lock_ = Descriptor(::open(working_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (lock_.get() < 0) refuse(target_, working_.string() + ": " + text_of(errno));
    if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) refuse(target_, "another run is writing it");
  } while (!is_still(working_, lock_));
}

/// What a run that was killed has left is taken over.
void OutputFolder::begin() {
  std::error_code error;
  if (!fs::is_empty(working_, error) && !fs::exists(working_ / kUnfinished, error))
    refuse(target_, fmt::format("{} is in the way, and no earlier run left it", working_.string()));
  partial_.emplace(working_);
  restore_old(working_, target_);
  check_replaceable(target_);
  if (!mark(working_)) cannot_write(target_, errno);
  for (const auto& entry : fs::directory_iterator(working_, error))
    if (entry.path().filename() != kUnfinished) fs::remove_all(entry.path(), error);
}

void OutputFolder::commit() {
  std::error_code error;
  remove_empty_folders(working_);  // no manifest could say whose they are
  write_file(working_ / kManifest, manifest_of(working_));
  const auto stays = [&](const std::string& why) {
    partial_->keep();
    for (const fs::path& folder : {working_, target_}) fs::remove(folder / kUnfinished, error);
    throw MachineError(
        fmt::format("cannot write {}: {}; the result is in {}", target_.string(), why, working_.string()));
  };
  const bool replaces = fs::exists(fs::symlink_status(target_, error));
  const Digests old = replaces ? read_manifest(target_) : Digests();
  // What came into it while we worked is a user's.
  if (const std::string why = why_not_replaceable(target_); !why.empty()) stays(why);
  // Both are marked: whichever lies under TARGET.part when the process dies is taken away by the next run.
  if (replaces && !mark(target_)) stays(text_of(errno));
  if (const int failure = replaces ? exchange(working_, target_) : move_new(working_, target_); failure != 0)
    stays(text_of(failure));
  // An interrupt neither ends the process between these nor stops them, as it would stop the reading of a
  // file: what lies under TARGET.part is the old result now.
  partial_->keep_after([&] {
    fs::remove(target_ / kUnfinished, error);
    if (replaces) remove_result(working_, old);
  });
}

}  // namespace understudy
