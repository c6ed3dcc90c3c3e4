#include "core/output_file.h"

#include <fstream>
#include <sstream>
#include <system_error>

#include <unistd.h>

#include "core/error.h"

namespace understudy {
namespace fs = std::filesystem;
namespace {

fs::path beside(const fs::path& target) {
  fs::path name = target;
  name += ".part-" + std::to_string(::getpid());
  return name;
}

[[noreturn]] void cannot(const std::string& what, const fs::path& path, const std::error_code& error) {
  throw InputError("cannot " + what + " " + path.string() + ": " + error.message());
}

}  // namespace

void write_file(const fs::path& path, const std::string& content) {
  const fs::path part = beside(path);
  {
    std::ofstream out(part, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out) {
      const std::error_code error(errno, std::generic_category());
      std::error_code ignored;
      fs::remove(part, ignored);
      cannot("write", path, error);
    }
  }
  std::error_code error;
  fs::rename(part, path, error);
  if (error) {
    std::error_code ignored;
    fs::remove(part, ignored);
    cannot("write", path, error);
  }
}

std::string read_file(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError("cannot read " + path.string() + ": it is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) cannot("read", path, std::error_code(errno, std::generic_category()));
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

OutputFolder::OutputFolder(fs::path target, std::string marker)
    : target_(std::move(target)), marker_(std::move(marker)) {
  while (!target_.has_filename() && target_.has_parent_path()) target_ = target_.parent_path();
  if (target_.empty()) throw InputError("the output folder has no name");
  std::error_code error;
  if (fs::exists(target_, error)) {
    if (!fs::is_directory(target_, error))
      throw InputError("cannot write " + target_.string() + ": it is a file");
    if (!fs::is_empty(target_, error) && !fs::exists(target_ / marker_, error))
      throw InputError("will not replace " + target_.string() + ": it is not empty and holds no " + marker_);
  }
  working_ = beside(target_);
  if (target_.has_parent_path()) fs::create_directories(target_.parent_path(), error);
  if (!error) fs::remove_all(working_, error);
  if (!error) fs::create_directory(working_, error);
  if (error) cannot("write", target_, error);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(working_, ignored);
}

void OutputFolder::commit() {
  // Two renames, not one: the older result stays under its name until the new one is whole.
  std::error_code error;
  fs::path old = working_;
  old += ".old";
  const bool replaces = fs::exists(target_, error);
  if (replaces) fs::rename(target_, old, error);
  if (error) cannot("replace", target_, error);
  fs::rename(working_, target_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(old, target_, ignored);
    cannot("write", target_, error);
  }
  committed_ = true;
  if (replaces) fs::remove_all(old, error);
}

}  // namespace understudy
