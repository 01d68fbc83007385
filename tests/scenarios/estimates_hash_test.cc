#include "scenarios/estimates_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

std::string hash_of(const std::vector<core::TargetEstimate>& estimates) {
  EstimatesHash hash;
  for (const core::TargetEstimate& estimate : estimates) hash.add(estimate);
  return hash.hex();
}

core::TargetEstimate some_estimate() {
  core::TargetEstimate e;
  e.t = 10ms;
  e.valid = true;
  e.p_world_tag_m << 1, 2, 3;
  e.v_world_tag_m_s << 4, 5, 6;
  e.heading_rad = 7;
  e.turn_rate_rad_s = 8;
  e.sigma_p_m << 9, 10, 11;
  e.last_tag = 9ms;
  return e;
}

TEST(EstimatesHash, OfNothingIsTheKnownDigestOfNoBytes) {
  // FIPS 180-4's SHA-256 of the empty message.
  EXPECT_EQ(hash_of({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(EstimatesHash, IsTheDigestOfLittleEndianWords) {
  // python3 -c 'import hashlib, struct; print(hashlib.sha256(struct.pack("<qQ11dq",
  //   10000, 1, *range(1, 12), 9000)).hexdigest())'
  EXPECT_EQ(hash_of({some_estimate()}),
            "d6401c6fb3bed6ad32b4287e43a4e3c6e737e3a2178ec42781982d713d72ab46");
}

TEST(EstimatesHash, ChangesWithTheLastBitOfEveryMember) {
  using Change = std::function<void(core::TargetEstimate&)>;
  const auto nudge = [](double& value) {
    value = std::nextafter(value, std::numeric_limits<double>::infinity());
  };
  std::vector<Change> changes{[](auto& e) { e.t += 1us; }, [](auto& e) { e.valid = false; },
                              [&](auto& e) { nudge(e.heading_rad); },
                              [&](auto& e) { nudge(e.turn_rate_rad_s); },
                              [](auto& e) { e.last_tag += 1us; }};
  for (int axis = 0; axis < 3; ++axis) {
    changes.push_back([&nudge, axis](auto& e) { nudge(e.p_world_tag_m[axis]); });
    changes.push_back([&nudge, axis](auto& e) { nudge(e.v_world_tag_m_s[axis]); });
    changes.push_back([&nudge, axis](auto& e) { nudge(e.sigma_p_m[axis]); });
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    core::TargetEstimate changed = some_estimate();
    changes[i](changed);
    EXPECT_NE(hash_of({changed}), hash_of({some_estimate()})) << i;
  }
}

TEST(EstimatesHash, ChangesWithOrderAndNumber) {
  core::TargetEstimate other = some_estimate();
  other.t = 20ms;
  EXPECT_NE(hash_of({some_estimate(), other}), hash_of({other, some_estimate()}));
  EXPECT_NE(hash_of({some_estimate()}), hash_of({some_estimate(), some_estimate()}));
}

TEST(EstimatesHash, MayBeReadBeforeTheEnd) {
  EstimatesHash hash;
  hash.add(some_estimate());
  EXPECT_EQ(hash.hex(), hash_of({some_estimate()}));
  hash.add(some_estimate());
  EXPECT_EQ(hash.hex(), hash_of({some_estimate(), some_estimate()}));
}

}  // namespace
}  // namespace nightjar::scenarios
