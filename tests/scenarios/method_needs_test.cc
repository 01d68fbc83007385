#include "scenarios/method_needs.h"

#include <gtest/gtest.h>

namespace nightjar::scenarios {
namespace {

esi::ReconstructorConfig config(esi::Method method) {
  esi::ReconstructorConfig config;
  config.method = method;
  return config;
}

TEST(MethodNeeds, are_weights_for_networks) {
  EXPECT_EQ(lacks_weights(config(esi::Method::e2vid)), "no weights: reconstructor.e2vid.weights");
  esi::ReconstructorConfig firenet = config(esi::Method::firenet);
  firenet.e2vid.weights = "others.onnx";
  EXPECT_EQ(lacks_weights(firenet), "no weights: reconstructor.firenet.weights");
  firenet.firenet.weights = "firenet.onnx";
  EXPECT_EQ(lacks_weights(firenet), "");
  EXPECT_EQ(lacks_weights(config(esi::Method::esi)), "");
}

TEST(MethodNeeds, are_no_frames_where_a_method_is_told_to_do_without) {
  EXPECT_FALSE(is_given_frames(config(esi::Method::esi)));
  EXPECT_TRUE(is_given_frames(config(esi::Method::edi)));
  esi::ReconstructorConfig filter = config(esi::Method::complementary_filter);
  EXPECT_TRUE(is_given_frames(filter));
  filter.complementary_filter.use_frames = false;
  EXPECT_FALSE(is_given_frames(filter));
  esi::ReconstructorConfig net = config(esi::Method::esi_net);
  EXPECT_TRUE(is_given_frames(net));
  net.esi_net.use_frames = false;
  EXPECT_FALSE(is_given_frames(net));
}

}  // namespace
}  // namespace nightjar::scenarios
