#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "msg/channels.h"
#include "msg/convert.h"

namespace nightjar::msg {

/// One place where messages are published and handed on. With `memq://`
/// everything stays in this process and in the order of publishing, so a run
/// that uses one thread is deterministic.
class Bus {
 public:
  using BytesHandler = std::function<void(std::span<const std::uint8_t>)>;

  /// Throws std::invalid_argument when LCM cannot open `url`. `udpm://` joins a group of
  /// processes, which sees what others publish; unless it says recv_buf_size itself it asks
  /// for a receive buffer of 4 MiB, of which the kernel grants net.core.rmem_max.
  explicit Bus(const std::string& url = "memq://");
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Queues a value; nothing is handled before dispatch(). With memq a message
  /// on a channel nobody has subscribed to is gone at once.
  /// Throws std::invalid_argument as encode() does, std::runtime_error when LCM
  /// does not take the message.
  template <class T>
  void publish(const Channel<T>& channel, const T& value) {
    publish_bytes(channel.name, encode(value));
  }

  /// Has `handler` called by dispatch() for every message of the channel, for as
  /// long as the bus lives; handlers of one channel in the order they came.
  template <class T>
  void subscribe(const Channel<T>& channel,
                 std::type_identity_t<std::function<void(const T&)>> handler) {
    subscribe_bytes(channel.name,
                    [handler = std::move(handler)](std::span<const std::uint8_t> bytes) {
                      handler(decode<T>(bytes));
                    });
  }

  /// The same for messages as they lie on the wire. A channel's name is letters,
  /// digits and underscores, at most 63; else std::invalid_argument.
  void publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes);
  void subscribe_bytes(const std::string& channel, BytesHandler handler);

  /// Handles messages first in, first out, also those that handlers publish
  /// meanwhile, until none is left; returns their number. What a handler or
  /// decode() throws comes out here; the messages after it stay queued.
  /// Throws std::logic_error when called from a handler.
  std::size_t dispatch();

  /// Waits until there is something for dispatch() to do, `at_most` so long, or until a
  /// signal comes; whether there is.
  bool wait(std::chrono::milliseconds at_most);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::msg
