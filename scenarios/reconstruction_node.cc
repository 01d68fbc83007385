#include "scenarios/reconstruction_node.h"

#include "esi/make_network.h"
#include "msg/channels.h"

namespace nightjar::scenarios {

ReconstructionNode::ReconstructionNode(msg::Bus& bus, const esi::ReconstructorConfig& config,
                                       core::Resolution size)
    : reconstructor_(esi::make_any_reconstructor(config, size)), feed_(*reconstructor_) {
  bus.subscribe(msg::kApsFrame, [this](const core::ApsFrame& frame) { feed_.add_frame(frame); });
  bus.subscribe(msg::kEvents, [this, &bus](const core::EventPacket& packet) {
    if (!begun_) reconstructor_->reset(packet.begin);  // a camera's clock did not begin with us
    begun_ = true;
    reconstructing_([&] {
      feed_.advance(packet.events, packet.end);
      reconstructor_->render(packet.end, picture_);
    });
    bus.publish(msg::kPicture, picture_);
  });
}

}  // namespace nightjar::scenarios
