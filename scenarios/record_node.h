#pragma once

#include <functional>

#include "msg/bus.h"
#include "scenarios/picture_record.h"

namespace nightjar::scenarios {

/// Gathers what belongs to one picture. A picture's record is whole with its
/// setpoint; `on_record` is called then.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class RecordNode {
 public:
  using OnRecord = std::function<void(const PictureRecord&)>;

  RecordNode(msg::Bus& bus, OnRecord on_record);

 private:
  PictureRecord record_;
  OnRecord on_record_;
};

}  // namespace nightjar::scenarios
