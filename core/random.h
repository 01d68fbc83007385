#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace nightjar::core {

using Random = std::mt19937_64;

/// An independent stream for each name: drawing from one never shifts another.
/// The same seed and name give the same whole numbers in every run and build; what
/// goes through a logarithm below is as exact as the C library's.
Random random_stream(std::uint64_t seed, std::string_view name);

/// Uniform in [0, 1), the same on every standard library.
double uniform01(Random& random);

/// Standard normal (Box-Muller), free of the C++ library's own choices.
double normal(Random& random);

/// Exponential with mean 1, free of the C++ library's own choices.
double exponential(Random& random);

}  // namespace nightjar::core
