#include "camera/natural_order.h"

#include <algorithm>

namespace nightjar::camera {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes a run of digits off the front, or else one other character.
std::string_view take_piece(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin()));
  const std::string_view piece = text.substr(0, length);
  text.remove_prefix(length);
  return piece;
}

/// Below, equal to or above 0 as `a` comes before, with or after `b`.
int compare_numbers(std::string_view a, std::string_view b) {
  a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
  b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const std::string_view piece_a = take_piece(rest_a), piece_b = take_piece(rest_b);
    const bool numbers = is_digit(piece_a[0]) && is_digit(piece_b[0]);
    const int order = numbers ? compare_numbers(piece_a, piece_b) : piece_a.compare(piece_b);
    if (order != 0) return order < 0;
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // frame02 and frame2
}

}  // namespace nightjar::camera
