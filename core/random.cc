#include "core/random.h"

#include <cmath>
#include <numbers>

namespace nightjar::core {
namespace {

// SplitMix64's finaliser (Steele, Lea, Flood: Fast splittable pseudorandom
// number generators, OOPSLA 2014): spreads near seeds over all 64 bits.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// FNV-1a, 64 bit.
std::uint64_t hash(std::string_view name) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return h;
}

}  // namespace

Random random_stream(std::uint64_t seed, std::string_view name) {
  return Random(mix(seed + 0x9e3779b97f4a7c15ULL) ^ hash(name));
}

double uniform01(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

double normal(Random& random) {
  const double u = 1.0 - uniform01(random);  // (0, 1]: the logarithm stays finite
  const double radius = std::sqrt(-2.0 * std::log(u));
  return radius * std::cos(2.0 * std::numbers::pi * uniform01(random));
}

double exponential(Random& random) { return -std::log(1.0 - uniform01(random)); }

}  // namespace nightjar::core
