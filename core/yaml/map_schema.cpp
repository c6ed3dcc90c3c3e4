#include "core/yaml/map_schema.h"

#include <tuple>

namespace understudy {

bool operator==(const KeySchema& a, const KeySchema& b) {
  const auto values = [](const KeySchema& s) {
    return std::tie(s.key, s.type, s.required, s.about, s.unit, s.bounds, s.words, s.count, s.maps);
  };
  return values(a) == values(b);
}

KeySchema key_schema(const std::string& key, KeySchema::Type type, const char* about) {
  KeySchema schema;
  schema.key = key;
  schema.type = type;
  schema.about = about;
  return schema;
}

}  // namespace understudy
