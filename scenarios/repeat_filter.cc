#include "scenarios/repeat_filter.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scenarios/process_roles.h"

namespace nightjar::scenarios {
namespace {

constexpr std::size_t kMostInAStep = 100'000;

bool closes_a_step(const msg::Message& message) {
  if (message.channel != msg::kStep.name) return false;
  try {
    return msg::decode<msg::StepMark>(message.bytes).sender == kFromSource.sender;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool is_of_a_source(const std::string& channel) {
  return channel == msg::kEventParts ||
         std::ranges::find(kFromSource.channels, channel) != kFromSource.channels.end();
}

std::uint64_t digest_of(const msg::Message& message) {
  const std::hash<std::string_view> digest;
  const std::string_view bytes(reinterpret_cast<const char*>(message.bytes.data()),
                               message.bytes.size());
  return digest(bytes) * 31 + digest(message.channel);
}

}  // namespace

bool RepeatFilter::is_repeat(const msg::Message& message) {
  const bool closes = closes_a_step(message);
  if (!closes && !is_of_a_source(message.channel)) return false;
  const std::uint64_t digest = digest_of(message);
  if (last_.contains(digest) || (heard_ && now_.contains(digest))) return true;
  if (now_.size() < kMostInAStep) now_.insert(digest);
  if (closes) {
    heard_ = true;
    last_ = std::exchange(now_, {});
  }
  return false;
}

}  // namespace nightjar::scenarios
