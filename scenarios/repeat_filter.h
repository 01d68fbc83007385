#pragma once

#include <cstdint>
#include <unordered_set>

#include "msg/message.h"

namespace nightjar::scenarios {

/// In lock-step a source sends a step again until it is answered, and lcm-logger writes down
/// every copy. This knows them: a message of the source that is the same, to the byte, as
/// one of the step before or of the step at hand. In logs without step marks nothing is sent
/// twice, so nothing is held for a copy.
class RepeatFilter {
 public:
  /// Whether it is a copy of one that came before; messages in the order of the log.
  bool is_repeat(const msg::Message& message);

 private:
  std::unordered_set<std::uint64_t> last_, now_;  ///< Digests of the steps' messages.
  bool heard_ = false;                            ///< A step mark of the source.
};

}  // namespace nightjar::scenarios
