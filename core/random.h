#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace nightjar::core {

using Random = std::mt19937_64;

/// An independent stream for each name: drawing from one never shifts another.
/// The same seed and name give the same numbers in every run and build.
Random random_stream(std::uint64_t seed, std::string_view name);

/// Uniform in [0, 1), the same on every standard library.
double uniform01(Random& random);

/// Standard normal, the same on every standard library (Box-Muller).
double normal(Random& random);

/// Exponential with mean 1, the same on every standard library.
double exponential(Random& random);

}  // namespace nightjar::core
