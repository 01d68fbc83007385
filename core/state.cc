#include "core/state.h"

namespace nightjar::core {

const char* to_string(MissionPhase phase) {
  switch (phase) {
    case MissionPhase::search: return "search";
    case MissionPhase::track: return "track";
    case MissionPhase::descend: return "descend";
    case MissionPhase::land: return "land";
    case MissionPhase::touched_down: return "touched_down";
  }
  return "?";
}

}  // namespace nightjar::core
