// The one source of randomness. A stream is named by (seed, purpose), so adding a consumer does not shift
// the numbers of another, and the numbers are the same on every platform and thread.
#pragma once

#include <cstdint>
#include <string_view>

namespace understudy {

class Random {
 public:
  /// Equal arguments give equal sequences.
  Random(std::uint64_t seed, std::string_view purpose);

  std::uint64_t bits();
  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, standard deviation 1

 private:
  std::uint64_t state_[4];
};

/// A stateless hash of a counter, uniform in 64 bits: noise that must not depend on evaluation order.
std::uint64_t hash_bits(std::uint64_t key, std::uint64_t counter);

}  // namespace understudy
