#include "core/file/file_cache.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "core/digest.h"
#include "core/file/read_file.h"

namespace understudy {
namespace {

struct Entry {
  FileCacheScope::Value value;
  std::uint64_t used = 0;  // for the last time
};

struct Cache {
  std::mutex mutex;
  int holders = 0;
  std::uint64_t asked = 0;
  std::map<std::pair<std::type_index, std::string>, Entry> files;
};

Cache& cache() {
  static Cache one;
  return one;
}

}  // namespace

FileCacheScope::FileCacheScope() {
  const std::lock_guard lock(cache().mutex);
  ++cache().holders;
}

FileCacheScope::~FileCacheScope() {
  decltype(Cache::files) forgotten;  // destroyed without the lock
  const std::lock_guard lock(cache().mutex);
  if (--cache().holders == 0) forgotten.swap(cache().files);
}

FileCacheScope::Value FileCacheScope::find(std::type_index type, const std::string& word) {
  const std::lock_guard lock(cache().mutex);
  const auto found = cache().files.find({type, word});
  if (found == cache().files.end()) return nullptr;
  found->second.used = ++cache().asked;
  return found->second.value;
}

FileCacheScope::Value FileCacheScope::keep(std::type_index type, const std::string& word, Value value) {
  const std::lock_guard lock(cache().mutex);
  auto& files = cache().files;
  if (cache().holders == 0) return value;
  if (files.size() >= kMost && !files.contains({type, word}))
    files.erase(std::min_element(files.begin(), files.end(),
                                 [](const auto& a, const auto& b) { return a.second.used < b.second.used; }));
  return files.try_emplace({type, word}, Entry{std::move(value), ++cache().asked}).first->second.value;
}

namespace {
struct Digest {
  std::string sha256;
};
}  // namespace

std::string cached_sha256(const std::filesystem::path& file) {
  return cached<Digest>(file.string(), [&] { return Digest{sha256_hex(read_file(file))}; })->sha256;
}

}  // namespace understudy
