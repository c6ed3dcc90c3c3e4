// What a reader of YAML maps asks for: the keys, and how they depend on what stands under other keys.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace understudy {

/// Both included, in the unit that the key names.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool operator==(const Bounds&) const = default;
};

struct MapSchema;

struct KeySchema {
  enum class Type { none, number, integer, text, numbers, map, list };
  std::string key;
  Type type = Type::none;  ///< none: the key was only looked for
  bool required = false;
  std::string about;               ///< one phrase
  std::string unit;                ///< "mm"; empty for text and for numbers without one
  Bounds bounds;                   ///< of numbers
  std::vector<std::string> words;  ///< a text must be one of these; empty: any text
  std::size_t count = 0;           ///< items of a list; 0: any number but none
  std::vector<MapSchema> maps;     ///< of a map: itself; of a list: one for all items, or one for each
};
bool operator==(const KeySchema& a, const KeySchema& b);
KeySchema key_schema(const std::string& key, KeySchema::Type type, const char* about);

/// A key whose presence or word decides which other keys follow.
struct Condition {
  std::string key;   ///< dotted where it stands in a map below: "geometry.urdf"
  std::string word;  ///< the key's word, or kPresent, kAbsent; "1" or "0" of something no key tells
  bool operator==(const Condition&) const = default;
};
inline constexpr const char* kPresent = "<present>";
inline constexpr const char* kAbsent = "<absent>";

/// The keys of a map under all of the conditions.
struct MapVariant {
  std::vector<Condition> when;
  std::vector<KeySchema> keys;
  bool operator==(const MapVariant&) const = default;
};

/// Every map that the reader accepts fits one variant (the reader may refuse it for other reasons).
struct MapSchema {
  std::vector<MapVariant> variants;
  bool operator==(const MapSchema&) const = default;
};

}  // namespace understudy
