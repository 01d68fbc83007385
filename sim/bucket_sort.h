#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace nightjar::sim {

/// Sorts `items`, whose keys are spread over [0, most]: time grows with items.size() as
/// long as they are spread evenly. `key(item)` is a std::uint64_t that tells in what order
/// they come, as far as `less` does not say more. The members are only room.
template <class Item>
class BucketSort {
 public:
  template <class Key, class Less>
  void sort(std::vector<Item>& items, std::uint64_t most, Key key, Less less) {
    if (items.size() < 2) return;
    const auto bits = [](std::uint64_t n) { return static_cast<int>(std::bit_width(n)); };
    const int shift = std::max(0, bits(most) - bits(items.size()));
    ends_.assign((most >> shift) + 2, 0);
    for (const Item& item : items) ++ends_[(key(item) >> shift) + 1];
    for (std::size_t b = 1; b < ends_.size(); ++b) ends_[b] += ends_[b - 1];
    sorted_.resize(items.size());
    for (const Item& item : items) sorted_[ends_[key(item) >> shift]++] = item;
    items.swap(sorted_);
    std::uint32_t begin = 0;
    for (const std::uint32_t end : ends_) {
      if (end > begin + 1) sort_bucket(items.data() + begin, items.data() + end, less);
      begin = end;
    }
  }

 private:
  template <class Less>
  static void sort_bucket(Item* begin, Item* end, Less less) {
    constexpr int kFew = 16;
    if (end - begin > kFew) return std::sort(begin, end, less);
    for (Item* i = begin + 1; i < end; ++i)
      for (Item* k = i; k > begin && less(*k, k[-1]); --k) std::swap(*k, k[-1]);
  }

  std::vector<std::uint32_t> ends_;
  std::vector<Item> sorted_;
};

}  // namespace nightjar::sim
