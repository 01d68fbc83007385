#pragma once

#include <string>

#include "msg/convert.h"

namespace nightjar::msg {

/// A message as it lies on the wire.
struct Message {
  std::string channel;
  Bytes bytes;

  friend bool operator==(const Message&, const Message&) = default;
};

}  // namespace nightjar::msg
