#include "scenarios/reconstruction_node.h"

#include "msg/channels.h"

namespace nightjar::scenarios {

ReconstructionNode::ReconstructionNode(msg::Bus& bus, const esi::EsiConfig& config,
                                       core::Resolution size)
    : esi_(config, size) {
  bus.subscribe(msg::kEvents, [this, &bus](const core::EventPacket& packet) {
    reconstructing_([&] {
      esi_.process(packet.events);
      esi_.render(packet.end, picture_);
    });
    bus.publish(msg::kPicture, picture_);
  });
}

}  // namespace nightjar::scenarios
