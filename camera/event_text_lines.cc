#include "camera/event_text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "camera/printable_text.h"
#include "camera/recording_intake.h"
#include "core/config_check.h"

namespace nightjar::camera {
namespace {

constexpr std::int64_t kMostSeconds = 999'999'999'999;
constexpr std::string_view kSpaces = " \t";

/// Where an error is.
struct Place {
  const std::string& name;
  std::size_t line = 0;
};

[[noreturn]] void fail(const Place& place, const std::string& why) {
  throw std::invalid_argument(fmt::format("{}:{}: {}", place.name, place.line, why));
}

/// Takes the next column off the line; empty at its end.
std::string_view take_column(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kSpaces), line.size()));
  const std::string_view column = line.substr(0, line.find_first_of(kSpaces));
  line.remove_prefix(column.size());
  return column;
}

std::string_view take_named_column(std::string_view& line, const char* name, const Place& place) {
  const std::string_view column = take_column(line);
  if (column.empty()) fail(place, fmt::format("no {}, expected: t_seconds x y polarity", name));
  return column;
}

/// The whole of `text` as a number; nothing where it is not one.
std::optional<int> parse_int(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Splits "12.5e-3" into "12.5" and -3.
std::optional<int> take_exponent(std::string_view& number) {
  constexpr int kMostExponent = 30;  // far beyond any time
  const std::size_t e = number.find_first_of("eE");
  if (e == std::string_view::npos) return 0;
  std::string_view text = number.substr(e + 1);
  if (text.starts_with("+-")) return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  number = number.substr(0, e);
  const std::optional<int> exponent = parse_int(text);
  return exponent && std::abs(*exponent) <= kMostExponent ? exponent : std::nullopt;
}

/// Decimal seconds, digit by digit: a double would lose the microseconds of large times.
std::optional<core::Time> parse_time(std::string_view text) {
  const std::optional<int> exponent = take_exponent(text);
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point);
  const std::string_view fraction = text.substr(std::min(point + 1, text.size()));
  const std::size_t digits = whole.size() + fraction.size();
  if (!exponent || digits == 0 || !all_digits(whole) || !all_digits(fraction)) return std::nullopt;

  const auto digit = [&](std::size_t i) {
    if (i >= digits) return 0;
    return (i < whole.size() ? whole[i] : fraction[i - whole.size()]) - '0';
  };
  constexpr int kMicro = 6;
  const auto counted = static_cast<std::int64_t>(whole.size()) + *exponent + kMicro;
  std::int64_t us = 0;
  for (std::int64_t i = 0; i < counted; ++i) {
    if (us > kMostTime.count() / 10) return std::nullopt;
    us = 10 * us + digit(static_cast<std::size_t>(i));
  }
  if (counted >= 0 && digit(static_cast<std::size_t>(counted)) >= 5) ++us;
  return us <= kMostTime.count() ? std::optional(core::Time(us)) : std::nullopt;
}

std::uint16_t parse_coordinate(std::string_view& line, const char* name, int side_px,
                               const Place& place) {
  const std::string_view column = take_named_column(line, name, place);
  const std::optional<int> value = parse_int(column);
  if (!value || *value < 0 || *value >= side_px)
    fail(place, fmt::format("{} = {}, allowed 0 to {}", name, printable_text(column), side_px - 1));
  return static_cast<std::uint16_t>(*value);
}

bool parse_polarity(std::string_view& line, const Place& place) {
  const std::string_view column = take_named_column(line, "polarity", place);
  if (column != "1" && column != "0" && column != "-1")
    fail(place, fmt::format("polarity = {}, allowed 1, 0 or -1", printable_text(column)));
  return column == "1";
}

core::Event parse_event(std::string_view line, core::Resolution limit, const Place& place) {
  const std::string_view seconds = take_named_column(line, "t_seconds", place);
  const std::optional<core::Time> t = parse_time(seconds);
  if (!t)
    fail(place,
         fmt::format("t_seconds = {}, allowed 0 to {}", printable_text(seconds), kMostSeconds));
  const std::uint16_t x = parse_coordinate(line, "x", limit.width_px, place);
  const std::uint16_t y = parse_coordinate(line, "y", limit.height_px, place);
  const bool on = parse_polarity(line, place);
  if (const std::string_view rest = take_column(line); !rest.empty())
    fail(place, fmt::format("'{}' after the polarity", printable_text(rest)));
  return {*t, x, y, on};
}

bool is_passed_over(std::string_view line) {
  const std::size_t first = line.find_first_not_of(kSpaces);
  return first == std::string_view::npos || line[first] == '#';
}

}  // namespace

EventTextLines::EventTextLines(std::istream& in, std::string name, core::Resolution limit)
    : in_(in), name_(std::move(name)), limit_(limit) {
  core::check_range("size.width_px", limit.width_px, 1, core::kMostSide_px);
  core::check_range("size.height_px", limit.height_px, 1, core::kMostSide_px);
}

bool EventTextLines::read_line() {
  text_.clear();
  ended_ = false;
  for (int c = in_.rdbuf()->sbumpc(); c != std::char_traits<char>::eof();
       c = in_.rdbuf()->sbumpc()) {
    ended_ = c == '\n';
    if (ended_) break;
    if (text_.size() == kMostLineBytes) {
      ended_ = true;
      fail({name_, line_ + 1}, fmt::format("more than {} bytes", kMostLineBytes));
    }
    text_ += static_cast<char>(c);
  }
  if (!ended_ && text_.empty()) return false;
  ++line_;
  bytes_ += text_.size() + (ended_ ? 1 : 0);
  return true;
}

bool EventTextLines::next(core::Event& event) {
  while (read_line()) {
    std::string_view line = text_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (is_passed_over(line)) continue;
    event = parse_event(line, limit_, {name_, line_});
    return true;
  }
  return false;
}

std::string EventTextLines::place() const { return fmt::format("{}:{}", name_, line_); }

}  // namespace nightjar::camera
