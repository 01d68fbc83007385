#pragma once

#include <stdexcept>
#include <string>

namespace nightjar::scenarios {

/// A scenario that cannot be flown. what() is one line for the person who wrote
/// it: "dark.yaml:7:3: esi.decay_hz = -1, allowed 0 to 1000".
class ScenarioError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// `text` fit for one line of a message: control characters replaced, the end cut.
std::string shown(const std::string& text);

/// As shown(), but whole: a file's own name stands at the end of its path.
std::string shown_file(std::string path);

}  // namespace nightjar::scenarios
