#include "core/error.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace understudy {

std::string to_string(const Place& place) {
  std::string s = place.file;
  if (place.line > 0) s += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) s += ":" + std::to_string(place.column);
  return s;
}

InputError::InputError(const std::string& message) : std::runtime_error(message) {}

InputError::InputError(const Place& place, const std::string& message)
    : std::runtime_error(place.file.empty() ? message : to_string(place) + ": " + message), place_(place) {}

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substitute, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace understudy
