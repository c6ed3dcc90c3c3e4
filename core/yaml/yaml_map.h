// Reads a YAML map and lets nothing pass unseen: a key that nobody asked for, a key that is missing or given
// twice, a value of the wrong type or beyond its range is an InputError with file, line and key.
//
// The suffix of a key is its unit in the file (lead_mm, tilt_deg). The phrase that goes with a key says what
// it means; the same reading code, run by schema(), tells what it would ask of any file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/frames.h"
#include "core/yaml/map_schema.h"

namespace YAML {  // NOLINT(readability-identifier-naming): the library's
class Node;
}

namespace understudy {

class SchemaRecording;

class YamlMap {
 public:
  using Read = std::function<void(YamlMap&)>;
  using ReadItem = std::function<void(YamlMap&, std::size_t index)>;

  /// Calls `read` for the file's map and checks afterwards that every key was asked for.
  static void read_text(const std::string& text, const std::string& file, const Read& read);
  /// What `read` asks for, over all answers that a file may give. Values are then 0 or empty, complete() is
  /// false, and `read` is called many times: it must come to the same questions whenever the answers are the
  /// same.
  static MapSchema schema(const Read& read);

  /// True when the file has the key: for what may be left out. It then counts as asked for. A key below is
  /// told with dots: "geometry.urdf"; that does not count as asking.
  bool has(const std::string& key);
  double quantity(const std::string& key, Bounds bounds, const char* about);  ///< SI
  std::vector<double> quantities(const std::string& key, std::size_t count, Bounds bounds, const char* about);
  Vec3 vector(const std::string& key, Bounds bounds, const char* about);    ///< SI, each within the bounds
  double number(const std::string& key, Bounds bounds, const char* about);  ///< as the file has it
  std::vector<double> numbers(const std::string& key, std::size_t count, Bounds bounds, const char* about);
  int integer(const std::string& key, int low, int high, const char* about);
  std::uint64_t seed(const std::string& key, const char* about);  ///< any whole number from 0
  std::string text(const std::string& key, const char* about);
  /// A text of one line, which may go into files of other programs.
  std::string name(const std::string& key, const char* about);
  /// A list of words or numbers as they are written; one of them may stand without brackets.
  std::vector<std::string> texts(const std::string& key, const char* about);
  /// One of `allowed`; of an empty list, any text.
  std::string word(const std::string& key, const std::vector<std::string>& allowed, const char* about);
  /// Throws InputError unless `value`, the text of `key`, is one of `allowed`.
  void check_word(const std::string& key, const std::string& value,
                  const std::vector<std::string>& allowed) const;
  void section(const std::string& key, const char* about, const Read& read);
  /// A sequence of maps, at least one. `count` is how many there should be, where that is known; the reader
  /// checks it, for it can say why.
  void list(const std::string& key, std::size_t count, const char* about, const ReadItem& read);
  /// In place of `list` while recording, where the items' schema is known: it costs a search over their
  /// readers.
  void record_list(const std::string& key, const char* about, const MapSchema& item);

  /// Throws InputError when the key is missing: where nothing can be read without it.
  void require(const std::string& key);
  /// Throws InputError saying `why` when the file has the key.
  void refuse(const std::string& key, const std::string& why) const;
  /// `actual`, which decides what is asked and which no key tells (of what machine a file is).
  bool either(const std::string& question, bool actual);

  /// Where the key's value stands, for checks that compare several values; the map itself when it is absent.
  Place place(const std::string& key) const;
  Place place() const { return place_; }
  /// "geometry.base_radius_mm"
  std::string path(const std::string& key) const;
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;  ///< at the key's place
  /// True when every key asked for so far was there: only then are the values worth comparing.
  bool complete() const { return recording_ == nullptr && first_missing_.empty(); }
  /// True when schema() asks.
  bool recording() const { return recording_ != nullptr; }

 private:
  YamlMap(const YAML::Node& node, std::string file, std::string path);
  explicit YamlMap(SchemaRecording& recording) : recording_(&recording) {}
  void finish() const;
  [[noreturn]] void fail_unknown(const std::string& key) const;
  /// Nothing when the key is missing: finish() will say so, unless a misspelt key explains it better.
  const YAML::Node* find(const std::string& key);
  double to_number(const YAML::Node& node, const std::string& key, Bounds bounds) const;
  std::vector<double> to_numbers(const std::string& key, std::size_t count, Bounds bounds);

  std::string file_;
  std::string path_;
  Place place_;
  std::map<std::string, std::shared_ptr<YAML::Node>> values_;
  std::map<std::string, Place> key_places_;
  std::vector<std::string> known_;
  std::string first_missing_;
  SchemaRecording* recording_ = nullptr;
};

}  // namespace understudy
