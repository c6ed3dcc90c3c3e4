#include "core/random.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace understudy {
namespace {

std::uint64_t splitmix(std::uint64_t& x) {
  x += 0x9E3779B97F4A7C15u;
  std::uint64_t z = x;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view purpose) {
  // FNV-1a over the purpose keeps streams apart; splitmix fills the state as xoshiro's authors advise.
  std::uint64_t x = 0xCBF29CE484222325u;
  for (const char c : purpose) x = (x ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  x ^= hash_bits(seed, 0);
  for (auto& s : state_) s = splitmix(x);
}

std::uint64_t Random::bits() {  // xoshiro256**
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::normal() {
  const double u = 1.0 - uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * uniform());
}

std::uint64_t hash_bits(std::uint64_t key, std::uint64_t counter) {
  std::uint64_t x = key ^ (counter * 0xD1342543DE82EF95u);
  const std::uint64_t a = splitmix(x);
  return a ^ splitmix(x);
}

}  // namespace understudy
