// One run of a reader that is asked for its keys, and the search over all its runs. Private to this room.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/yaml/map_schema.h"

namespace understudy {

/// An answer that the recording gave, with all it could have given.
struct Decision {
  std::string key;
  std::vector<std::string> answers;
  std::size_t chosen = 0;
};

class SchemaRecording {
 public:
  /// Gives the answers of `path`, and the first one to every further question.
  explicit SchemaRecording(std::vector<Decision> path) : decisions_(std::move(path)) {}

  /// One of `answers`; the same key is answered alike in one run.
  std::string decide(const std::string& key, const std::vector<std::string>& answers);
  void look_for(const std::string& key);
  /// The key was read: required unless it was found first.
  void ask(KeySchema schema);

  const std::vector<Decision>& decisions() const { return decisions_; }
  const std::vector<KeySchema>& keys() const { return keys_; }

 private:
  KeySchema* find(const std::string& key);

  std::vector<Decision> decisions_;
  std::size_t next_ = 0;
  std::map<std::string, std::string> answered_;
  std::vector<KeySchema> keys_;
};

/// All variants of the map that `run` reads.
MapSchema explore(const std::function<void(SchemaRecording&)>& run);

}  // namespace understudy
