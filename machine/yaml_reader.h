// Reads a YAML map and lets nothing pass unseen: a key that nobody asked for, a key that is missing or given
// twice, a value of the wrong type or beyond its range is an InputError with file, line and key.
//
// The suffix of a key is its unit in the file (lead_mm, tilt_deg); quantities come out in SI.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/frames.h"

namespace YAML {
class Node;
}

namespace understudy::machine {

/// Bounds in the unit that the key names, both included.
struct Bounds {
  double low;
  double high;
};

class YamlMap {
 public:
  using Read = std::function<void(YamlMap&)>;

  /// Calls `read` for the file's map and checks afterwards that every key was asked for.
  static void read_text(const std::string& text, const std::string& file, const Read& read);

  /// True when the file has the key: for what may be left out. It then counts as asked for.
  bool has(const std::string& key);
  double quantity(const std::string& key, Bounds bounds);  ///< SI
  std::vector<double> quantities(const std::string& key, std::size_t count, Bounds bounds);
  Vec3 vector(const std::string& key, Bounds bounds);  ///< SI, each component within the bounds
  int integer(const std::string& key, int low, int high);
  std::string text(const std::string& key);
  std::string word(const std::string& key, const std::vector<std::string>& allowed);
  void section(const std::string& key, const Read& read);
  /// A sequence of maps, at least one.
  void list(const std::string& key, const Read& read);

  /// Where the key's value stands, for checks that compare several values; the map itself when it is absent.
  Place place(const std::string& key) const;
  Place place() const;
  /// "geometry.base_radius_mm"
  std::string path(const std::string& key) const;
  /// True when every key asked for so far was there: only then are the values worth comparing.
  bool complete() const { return first_missing_.empty(); }

 private:
  YamlMap(const YAML::Node& node, std::string file, std::string path);
  void finish() const;
  /// Nothing when the key is missing: finish() will say so, unless a misspelt key explains it better.
  const YAML::Node* find(const std::string& key);
  double number(const YAML::Node& node, const std::string& key, Bounds bounds) const;

  std::string file_;
  std::string path_;
  Place place_;
  std::map<std::string, std::shared_ptr<YAML::Node>> values_;
  std::map<std::string, Place> key_places_;
  std::vector<std::string> known_;
  std::string first_missing_;
};

}  // namespace understudy::machine
