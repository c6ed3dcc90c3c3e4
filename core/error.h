// The errors that cross rooms. Each becomes one line on standard error and one exit status.
#pragma once

#include <stdexcept>
#include <string>

namespace understudy {

/// Where in a user's file something is wrong. Line and column count from 1; 0 means unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "bottle.gcode:12:7", leaving out what is unknown.
std::string to_string(const Place& place);

/// Bad input or usage: exit status 2. The message names quantity, value, limit and place, on one line:
/// "bottle.gcode:1187: strut 3 is 241.7 mm, longer than 240.0 mm".
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const Place& place, const std::string& message);
  const Place& place() const { return place_; }

 private:
  Place place_;
};

/// The machine, or the engine that plays it, failed: exit status 3.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user interrupted long work. Nothing is left under a final name.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// The candidate nearest to `word` by edit distance, for "did you mean"; empty when none is near.
template <typename Range>
std::string nearest_word(const std::string& word, const Range& candidates);
int edit_distance(const std::string& a, const std::string& b);

template <typename Range>
std::string nearest_word(const std::string& word, const Range& candidates) {
  std::string best;
  int best_distance = 1 + static_cast<int>(word.size()) / 2;
  for (const auto& candidate : candidates) {
    const int distance = edit_distance(word, std::string(candidate));
    if (distance < best_distance) {
      best_distance = distance;
      best = std::string(candidate);
    }
  }
  return best;
}

}  // namespace understudy
