#pragma once

#include <exception>

namespace nightjar::tools {

/// Thrown between two steps of a run after Ctrl-C.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// From now on SIGINT and SIGTERM are noted instead of ending the process; a
/// second one ends it.
void note_interrupts();

/// Whether a signal has been noted.
bool interrupted();

/// Throws Interrupted once one has.
void throw_if_interrupted();

}  // namespace nightjar::tools
