#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace nightjar::sim {

/// Sorts `items` by `key(item)`, an unsigned number below 2^key_bits; equal keys keep
/// their order. Time grows with items.size() * key_bits / 11. `scratch` is only room.
template <class Item, class Key>
void radix_sort(std::vector<Item>& items, std::vector<Item>& scratch, int key_bits, Key key) {
  constexpr int kDigitBits = 11;
  constexpr std::uint32_t kMask = (1u << kDigitBits) - 1;
  scratch.resize(items.size());
  for (int shift = 0; shift < key_bits; shift += kDigitBits) {
    std::array<std::uint32_t, kMask + 1> place{};  // first the counts, then where to put
    for (const Item& item : items) ++place[(key(item) >> shift) & kMask];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : place) {
      const std::uint32_t count = p;
      p = sum;
      sum += count;
    }
    for (const Item& item : items) scratch[place[(key(item) >> shift) & kMask]++] = item;
    items.swap(scratch);
  }
}

}  // namespace nightjar::sim
