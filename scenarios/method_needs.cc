#include "scenarios/method_needs.h"

#include <fmt/format.h>

#include "scenarios/choice_text.h"

namespace nightjar::scenarios {

std::string lacks_weights(const esi::ReconstructorConfig& config) {
  const bool lacks = (config.method == esi::Method::firenet && config.firenet.weights.empty()) ||
                     (config.method == esi::Method::e2vid && config.e2vid.weights.empty());
  if (!lacks) return {};
  return fmt::format("no weights: reconstructor.{}.weights",
                     choice_name(config.method, esi::kMethods));
}

bool starts_from_frames(esi::Method method) {
  return method == esi::Method::edi || method == esi::Method::fedi;
}

bool is_given_frames(const esi::ReconstructorConfig& config) {
  if (config.method == esi::Method::complementary_filter)
    return config.complementary_filter.use_frames;
  if (config.method == esi::Method::esi_net) return config.esi_net.use_frames;
  return starts_from_frames(config.method);
}

}  // namespace nightjar::scenarios
