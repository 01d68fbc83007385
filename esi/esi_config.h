#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

enum class EsiOrder {
  add_then_decay,  ///< The paper's: an event that comes late wipes itself out, too.
  decay_then_add,  ///< Keeps it.
};

inline constexpr core::Choices<EsiOrder, 2> kEsiOrders{
    {{"add_then_decay", EsiOrder::add_then_decay}, {"decay_then_add", EsiOrder::decay_then_add}}};

/// Event-based single integration (ESI paper, section III). The paper gives no
/// values. On seeds 201 and 202 of a shortened tracking_landing scenario the share of
/// pictures with the tag changed by less than two points between C = 0.15 and 0.3 and
/// between k = 1 and 2: these values lie on that plateau.
struct EsiConfig {
  double contrast_log = 0.2;   ///< C: step per event, natural log units.
  double decay_rate_hz = 1.0;  ///< k: an event 1/k after its predecessor wipes the pixel.
  double decay_power = 1.0;    ///< b.
  double least_log = -1.0;     ///< Smin, black.
  double greatest_log = 1.0;   ///< Smax, white.
  EsiOrder order = EsiOrder::add_then_decay;
  bool decay_at_picture = false;  ///< Decay from the last event to the picture, too.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("contrast_log", contrast_log, 0.001, 2.0);
    v.field("decay_rate_hz", decay_rate_hz, 0.0, 1000.0);
    v.field("decay_power", decay_power, 0.01, 20.0);
    v.field("least_log", least_log, -100.0, 0.0);
    v.field("greatest_log", greatest_log, 0.001, 100.0);
    v.choice("order", order, kEsiOrders);
    v.field("decay_at_picture", decay_at_picture);
  }
};

}  // namespace nightjar::esi
