#include "msg/event_parts.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;

/// Two events of every microsecond, all of one pixel.
core::EventPacket packet_of(std::size_t events) {
  core::EventPacket packet{100us, 100us + core::Time(static_cast<std::int64_t>(events)), {}};
  for (std::size_t i = 0; i < events; ++i)
    packet.events.push_back({101us + core::Time(static_cast<std::int64_t>(i / 2)), 345, 259, true});
  return packet;
}

TEST(EventParts, APacketCutAndJoinedHasTheSameBytes) {
  for (const std::size_t events : {0u, 1u, 9u, 10u, 11u, 35u}) {
    const Bytes whole = encode(packet_of(events));
    const std::vector<Bytes> parts = cut_events(whole, 7, 10);
    EXPECT_EQ(parts.size(), std::max<std::size_t>(1, (events + 9) / 10)) << events;
    EXPECT_EQ(join_events(parts), std::vector<Bytes>{whole}) << events;
  }
}

TEST(EventParts, EachPieceIsOneDatagram) {
  // What LCM (lcm_udpm.c, LCM_SHORT_MESSAGE_MAX_SIZE) sends without cutting it, with head
  // and channel.
  constexpr std::size_t kMostBytes = 65'499, kHeadBytes = 8 + sizeof("NIGHTJAR_EVENT_PARTS");
  for (const Bytes& part : cut_events(encode(packet_of(20'000)), 0))
    EXPECT_LE(part.size() + kHeadBytes, kMostBytes);
}

TEST(EventParts, WithoutALostPieceTheEventsOfTheOthersStay) {
  const core::EventPacket packet = packet_of(30);
  std::vector<Bytes> parts = cut_events(encode(packet), 0, 10);
  parts.erase(parts.begin() + 1);
  const std::vector<Bytes> joined = join_events(parts);
  ASSERT_EQ(joined.size(), 1u);
  const auto got = decode<core::EventPacket>(joined.front());
  std::vector<core::Event> expected = packet.events;
  expected.erase(expected.begin() + 10, expected.begin() + 20);
  EXPECT_EQ(got.events, expected);
  EXPECT_EQ(got.begin, packet.begin);
  EXPECT_EQ(got.end, packet.end);
}

TEST(EventParts, PacketsThatFollowEachOtherStayApart) {
  const Bytes first = encode(packet_of(15)), second = encode(packet_of(3));
  std::vector<Bytes> parts = cut_events(first, 0, 10);
  for (Bytes& part : cut_events(second, 1, 10)) parts.push_back(std::move(part));
  EXPECT_EQ(join_events(parts), (std::vector<Bytes>{first, second}));
}

TEST(EventParts, RefusesWhatIsNoPacketAndNoPiece) {
  const Bytes packet = encode(packet_of(3));
  EXPECT_THROW(join_events(std::vector<Bytes>{packet}), std::invalid_argument);
  EXPECT_THROW(cut_events(Bytes(40), 0), std::invalid_argument);
  Bytes boasting = cut_events(packet, 0).front();
  boasting[8 + 3 * 8 + 2 * 4] = 0x7f;  // the count's first byte
  EXPECT_THROW(join_events(std::vector<Bytes>{boasting}), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::msg
