#include "core/file/kept_files.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "core/digest.h"
#include "core/file/read_file.h"

namespace understudy {
namespace {

struct Kept {
  KeptFiles::Value value;
  std::uint64_t asked = 0;  // for the last time
};

struct Shelf {
  std::mutex mutex;
  int holders = 0;
  std::uint64_t asked = 0;
  std::map<std::pair<std::type_index, std::string>, Kept> files;
};

Shelf& shelf() {
  static Shelf one;
  return one;
}

}  // namespace

KeptFiles::KeptFiles() {
  const std::lock_guard lock(shelf().mutex);
  ++shelf().holders;
}

KeptFiles::~KeptFiles() {
  decltype(Shelf::files) forgotten;  // destroyed without the lock
  const std::lock_guard lock(shelf().mutex);
  if (--shelf().holders == 0) forgotten.swap(shelf().files);
}

KeptFiles::Value KeptFiles::find(std::type_index type, const std::string& word) {
  const std::lock_guard lock(shelf().mutex);
  const auto found = shelf().files.find({type, word});
  if (found == shelf().files.end()) return nullptr;
  found->second.asked = ++shelf().asked;
  return found->second.value;
}

KeptFiles::Value KeptFiles::keep(std::type_index type, const std::string& word, Value value) {
  const std::lock_guard lock(shelf().mutex);
  auto& files = shelf().files;
  if (shelf().holders == 0) return value;
  if (files.size() >= kMost && !files.contains({type, word}))
    files.erase(std::min_element(files.begin(), files.end(), [](const auto& a, const auto& b) {
      return a.second.asked < b.second.asked;
    }));
  return files.try_emplace({type, word}, Kept{std::move(value), ++shelf().asked}).first->second.value;
}

namespace {
struct Digest {
  std::string sha256;
};
}  // namespace

std::string kept_sha256(const std::filesystem::path& file) {
  return kept<Digest>(file.string(), [&] { return Digest{sha256_hex(read_file(file))}; })->sha256;
}

}  // namespace understudy
