#include "msg/bus.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace nightjar::msg {
namespace {

// LCM reads a subscription as a regular expression, and holds 63 characters.
void check_channel(const std::string& channel) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (channel.empty() || channel.size() > 63 || !std::ranges::all_of(channel, allowed))
    throw std::invalid_argument(
        fmt::format("channel = \"{}\", allowed 1 to 63 letters, digits and underscores", channel));
}

// A burst of events must find room before LCM's thread gets to read it.
std::string with_receive_buffer(const std::string& url) {
  if (!url.starts_with("udpm://") || url.find("recv_buf_size") != std::string::npos) return url;
  return url + (url.find('?') == std::string::npos ? '?' : '&') + "recv_buf_size=4194304";
}

}  // namespace

struct Bus::Impl {
  struct Subscriber {
    Impl* bus;
    BytesHandler handler;
  };

  // Called from C, which an exception must not unwind: LCM would stay locked.
  static void handle(const lcm::ReceiveBuffer* buffer, const std::string&, Subscriber* to) {
    if (to->bus->failure) return;  // dispatch() is about to throw
    try {
      to->handler({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    } catch (...) {
      to->bus->failure = std::current_exception();
    }
  }

  explicit Impl(const std::string& url) : lcm(with_receive_buffer(url)) {}

  lcm::LCM lcm;
  std::deque<Subscriber> subscribers;  // a deque, for LCM keeps their addresses
  std::exception_ptr failure;
  bool dispatching = false;
};

Bus::Bus(const std::string& url) : impl_(std::make_unique<Impl>(url)) {
  if (!impl_->lcm.good())
    throw std::invalid_argument(fmt::format("url = \"{}\", which LCM cannot open", url));
}

Bus::~Bus() = default;

void Bus::publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
  check_channel(channel);
  if (impl_->lcm.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0)
    throw std::runtime_error(
        fmt::format("{}: LCM did not take a message of {} bytes", channel, bytes.size()));
}

void Bus::subscribe_bytes(const std::string& channel, BytesHandler handler) {
  check_channel(channel);
  auto& subscriber = impl_->subscribers.emplace_back(impl_.get(), std::move(handler));
  auto* subscription = impl_->lcm.subscribeFunction(channel, &Impl::handle, &subscriber);
  // By default a network's messages after the 30th are dropped; 0 is no limit.
  if (subscription->setQueueCapacity(0) != 0)
    throw std::runtime_error(fmt::format("{}: LCM refused an unlimited queue", channel));
}

std::size_t Bus::dispatch() {
  if (impl_->dispatching) throw std::logic_error("dispatch() called from a handler");
  std::size_t count = 0;
  int status = 0;
  do {
    impl_->dispatching = true;
    status = impl_->lcm.handleTimeout(0);
    impl_->dispatching = false;
    if (impl_->failure) std::rethrow_exception(std::exchange(impl_->failure, nullptr));
    if (status > 0) ++count;
  } while (status > 0);
  if (status < 0) throw std::runtime_error("LCM failed to handle a message");
  return count;
}

bool Bus::wait(std::chrono::milliseconds at_most) {
  pollfd file{.fd = impl_->lcm.getFileno(), .events = POLLIN, .revents = 0};
  return poll(&file, 1, static_cast<int>(at_most.count())) > 0;
}

}  // namespace nightjar::msg
