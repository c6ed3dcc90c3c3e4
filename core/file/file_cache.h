// Input files that many runs of one process share.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <typeindex>
#include <typeinfo>

namespace understudy {

/// While one lives, cached() reads each file of this process once, whoever asks and on whichever thread: runs
/// of a campaign share machines and meshes. What is written to a file meanwhile is not seen.
class FileCacheScope {
 public:
  static constexpr std::size_t kMost = 64;  ///< the least recently used makes room

  FileCacheScope();
  ~FileCacheScope();  ///< the last one forgets all
  FileCacheScope(const FileCacheScope&) = delete;
  FileCacheScope& operator=(const FileCacheScope&) = delete;

  using Value = std::shared_ptr<const void>;
  /// For cached(), which knows the type. Nothing where no scope lives or the file is not cached.
  static Value find(std::type_index type, const std::string& word);
  /// Returns what is cached from now on: `value`, unless another thread was first.
  static Value keep(std::type_index type, const std::string& word, Value value);
};

/// What `read` makes of the file that `word` names, or what it made of it for the first who asked. When it
/// throws, nothing is cached.
template <typename T>
std::shared_ptr<const T> cached(const std::string& word, const std::function<T()>& read) {
  const std::type_index type = typeid(T);
  if (const auto found = FileCacheScope::find(type, word)) return std::static_pointer_cast<const T>(found);
  return std::static_pointer_cast<const T>(
      FileCacheScope::keep(type, word, std::make_shared<const T>(read())));
}

/// SHA-256 of a file's bytes, cached like what they say. Throws as read_file() does.
std::string cached_sha256(const std::filesystem::path& file);

}  // namespace understudy
