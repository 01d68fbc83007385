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
    std::uint32_t most_in_one = 0;
    for (std::size_t b = 1; b < ends_.size(); ++b) {
      most_in_one = std::max(most_in_one, ends_[b]);
      ends_[b] += ends_[b - 1];
    }
    sorted_.resize(items.size());
    for (const Item& item : items) sorted_[ends_[key(item) >> shift]++] = item;
    items.swap(sorted_);
    if (most_in_one <= kFew)
      insert(items.data(), items.data() + items.size(), less);
    else
      sort_buckets(items, less);
  }

 private:
  static constexpr std::uint32_t kFew = 16;

  /// Quick where items are near their places.
  template <class Less>
  static void insert(Item* begin, Item* end, Less less) {
    for (Item* i = begin + 1; i < end; ++i) {
      if (!less(*i, i[-1])) continue;
      const Item item = *i;
      Item* k = i;
      do *k = k[-1];
      while (--k > begin && less(item, k[-1]));
      *k = item;
    }
  }

  template <class Less>
  void sort_buckets(std::vector<Item>& items, Less less) {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : ends_) {
      if (end > begin + kFew)
        std::sort(items.data() + begin, items.data() + end, less);
      else if (end > begin + 1)
        insert(items.data() + begin, items.data() + end, less);
      begin = end;
    }
  }

  std::vector<std::uint32_t> ends_;
  std::vector<Item> sorted_;
};

}  // namespace nightjar::sim
