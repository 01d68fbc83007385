#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "esi/network_config.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// A recurrent network run by OpenCV: E2VID (Rebecq et al. 2019), FireNet (Scheerlinck et
/// al. 2020) and what has their shape. In: `voxels`, the VoxelGrid of the events since the
/// last picture, 1x5xHxW, and any number of states `state0_in`, `state1_in`, ..., 0 at
/// first. Out: `image`, 1x1xHxW, and `state0_out`, ... of the shapes that went in.
///
/// The file tells how many channels the states have and how much smaller than the voxels
/// they are; the planes are the sensor's, grown to the right and down with zeros to a
/// multiple of that. So networks of convolutions run at any size of sensor, others at the
/// file's own.
///
/// Each picture with new events advances the network by one step, another look does not.
/// Until the first, all is mid-grey. Of the events between two pictures the newest
/// kMostEvents count.
class RecurrentNetwork final : public Reconstructor {
 public:
  static constexpr std::size_t kMostEvents = 10'000'000;

  /// `name` is the method's, for messages. Throws std::invalid_argument where no weights
  /// are set, the file is no ONNX network or one with other tensors, and where it does not
  /// run at this size.
  RecurrentNetwork(const std::string& name, const NetworkConfig& config, core::Resolution size);
  ~RecurrentNetwork() override;

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  void advance();

  struct Net;
  NetworkConfig config_;
  std::unique_ptr<Net> net_;
  std::vector<PackedEvent> events_;  ///< Since the last picture.
  core::Image<std::uint8_t> picture_;
};

}  // namespace nightjar::esi
