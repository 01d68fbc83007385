#include "msg/convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>

#include "core/random.h"

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kFirst{std::numeric_limits<std::int64_t>::min()};
constexpr core::Time kLast{std::numeric_limits<std::int64_t>::max()};
constexpr int kRounds = 200;

/// Values of any bit pattern: infinities, NaN and denormals among them. Equality
/// below is therefore of bits.
class AnyValues {
 public:
  explicit AnyValues(std::uint64_t seed) : random_(core::random_stream(seed, "convert")) {}

  std::uint64_t bits() { return random_(); }
  bool flag() { return bits() % 2 != 0; }
  core::Time time() { return core::Time(static_cast<std::int64_t>(bits())); }
  int integer() { return static_cast<int>(static_cast<std::uint32_t>(bits())); }
  int integer(int below) { return static_cast<int>(bits() % static_cast<unsigned>(below)); }
  double number() { return std::bit_cast<double>(bits()); }
  Eigen::Vector3d vector() { return {number(), number(), number()}; }
  Eigen::Quaterniond quaternion() { return {number(), number(), number(), number()}; }
  Eigen::Isometry3d transform() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) T.matrix()(row, column) = number();
    return T;
  }
  core::Image<std::uint8_t> image(core::Resolution size) {
    core::Image<std::uint8_t> image(size);
    for (std::uint8_t& pixel : image.pixels()) pixel = static_cast<std::uint8_t>(bits());
    return image;
  }
  core::ApsFrame frame(core::Resolution size, int frame_bits) {
    core::ApsFrame frame{time(), time(), frame_bits, core::Image<std::uint16_t>(size)};
    for (std::uint16_t& pixel : frame.gray.pixels())
      pixel = static_cast<std::uint16_t>(bits() >> (64 - frame_bits));
    return frame;
  }
  core::TagDetection tag(core::Time t) {
    core::TagDetection tag;
    tag.t = t;
    tag.id = integer();
    tag.hamming = integer();
    tag.decision_margin = number();
    for (Eigen::Vector2d& corner : tag.corner_px) corner = {number(), number()};
    return tag;
  }
  core::VehicleState vehicle_state() {
    return {time(), vector(), vector(), quaternion(), vector()};
  }

 private:
  core::Random random_;
};

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class Derived>
bool same(const Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
  for (Eigen::Index row = 0; row < a.rows(); ++row)
    for (Eigen::Index column = 0; column < a.cols(); ++column)
      if (!same(a(row, column), b(row, column))) return false;
  return true;
}

bool same(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return same(a.coeffs(), b.coeffs());
}

bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return same(a.matrix(), b.matrix());
}

bool same(const core::VehicleState& a, const core::VehicleState& b) {
  return a.t == b.t && same(a.p_world_body_m, b.p_world_body_m) &&
         same(a.v_world_body_m_s, b.v_world_body_m_s) && same(a.q_world_body, b.q_world_body) &&
         same(a.omega_body_rad_s, b.omega_body_rad_s);
}

template <class T>
T round_trip(const T& value) {
  return decode<T>(encode(value));
}

/// Events anywhere in the packet, in order, with every field over its full range.
core::EventPacket random_packet(AnyValues& any, core::Time begin, core::Time length) {
  core::EventPacket packet{begin, begin + length, {}};
  const auto us = static_cast<std::uint64_t>(length.count());
  for (std::uint64_t n = us == 0 ? 0 : any.bits() % 500; n > 0; --n)
    packet.events.push_back({begin + core::Time(1 + static_cast<std::int64_t>(any.bits() % us)),
                             static_cast<std::uint16_t>(any.bits()),
                             static_cast<std::uint16_t>(any.bits()), any.flag()});
  std::ranges::stable_sort(packet.events, {}, &core::Event::t);
  return packet;
}

TEST(Convert, EventPacketsKeepEveryBit) {
  AnyValues any(1);
  for (const core::Time length : {0us, 1us, 10'000us, 2'147'483'647us})
    for (int round = 0; round < kRounds; ++round) {
      const core::EventPacket sent = random_packet(any, any.time() / 2, length);
      const core::EventPacket got = round_trip(sent);
      EXPECT_EQ(got.begin, sent.begin);
      EXPECT_EQ(got.end, sent.end);
      EXPECT_EQ(got.events, sent.events);
    }
}

TEST(Convert, EventPacketsMayLieAtEitherEndOfTime) {
  for (const core::Time begin : {kFirst, kLast - 10us}) {
    const core::EventPacket sent{begin, begin + 10us, {{begin + 10us, 65535, 65535, true}}};
    EXPECT_EQ(round_trip(sent).events, sent.events);
  }
}

TEST(Convert, AnEventBehindItsPacketsEndIsRefusedBeforeItsTimeIsFormed) {
  const core::Time begin(std::numeric_limits<std::int64_t>::max() - 5);
  Bytes bytes = encode(core::EventPacket{begin, begin + 4us, {{begin + 4us, 1, 2, true}}});
  EXPECT_EQ(decode<core::EventPacket>(bytes).events.at(0).t, begin + 4us);
  bytes[bytes.size() - 5] |= 200;  // of the word's upper 32 bits 31 are the time: 100 us more
  EXPECT_THAT([&] { decode<core::EventPacket>(bytes); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("event 100 us after its beginning, allowed 0 to 4 us")));
}

TEST(Convert, EventPacketsThatBreakTheirPromiseAreRefused) {
  const auto refused = [](const core::EventPacket& packet) {
    EXPECT_THROW(encode(packet), std::invalid_argument);
  };
  refused({10us, 20us, {{10us, 0, 0, true}}});                      // begin is open
  refused({10us, 20us, {{21us, 0, 0, true}}});                      // end is closed
  refused({10us, 20us, {{12us, 0, 0, true}, {11us, 0, 0, true}}});  // order
  refused({20us, 10us, {}});
  refused({0us, 2'147'483'648us, {}});  // 32 bits
  refused({kFirst, kLast, {}});
}

TEST(Convert, PicturesKeepEveryBit) {
  AnyValues any(2);
  for (const core::Resolution size : {core::Resolution{}, {1, 1}, {0, 7}, {346, 260}, {3, 1000}}) {
    const core::Picture sent{any.time(), any.image(size)};
    const core::Picture got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    EXPECT_EQ(got.gray, sent.gray);
  }
}

TEST(Convert, ApsFramesKeepEveryBit) {
  AnyValues any(3);
  for (const int bits : {8, 10, 16}) {
    const core::ApsFrame sent = any.frame({346, 260}, bits);
    EXPECT_EQ(std::ranges::max(sent.gray.pixels()), (1 << bits) - 1);
    const core::ApsFrame got = round_trip(sent);
    EXPECT_EQ(got.exposure_begin, sent.exposure_begin);
    EXPECT_EQ(got.exposure_end, sent.exposure_end);
    EXPECT_EQ(got.bits, bits);
    EXPECT_EQ(got.gray, sent.gray);
  }
}

TEST(Convert, ApsFramesBeyondTheirBitsAreRefused) {
  AnyValues any(12);
  core::ApsFrame frame = any.frame({4, 3}, 10);
  frame.gray(1, 1) = 1024;
  EXPECT_THROW(encode(frame), std::invalid_argument);
  for (const int bits : {-1, 0, 9, 15, 17, 40}) {
    frame = any.frame({4, 3}, 8);
    frame.bits = bits;
    EXPECT_THROW(encode(frame), std::invalid_argument) << bits;
  }
  Bytes bytes = encode(any.frame({4, 3}, 8));
  bytes[40] = 1;  // higher byte of the first pixel: 256 or more
  EXPECT_THROW(decode<core::ApsFrame>(bytes), std::invalid_argument);
}

TEST(Convert, ImuSamplesKeepEveryBit) {
  AnyValues any(13);
  for (int round = 0; round < kRounds; ++round) {
    const core::ImuSample sent{any.time(), any.vector(), any.vector()};
    const core::ImuSample got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    EXPECT_TRUE(same(got.omega_camera_rad_s, sent.omega_camera_rad_s));
    EXPECT_TRUE(same(got.specific_force_camera_m_s2, sent.specific_force_camera_m_s2));
  }
}

TEST(Convert, NotesOnACameraKeepEveryBit) {
  AnyValues any(14);
  for (int round = 0; round < kRounds; ++round) {
    const SensorNote sensor{any.time(), {1 + any.integer(32767), 1 + any.integer(32767)}, "DAVIS"};
    EXPECT_EQ(round_trip(sensor), sensor);
    const TriggerNote trigger{any.time(), any.integer(128)};
    EXPECT_EQ(round_trip(trigger), trigger);
    const ReadoutNote readout{any.time(), any.time(), any.time(), any.integer(), any.integer()};
    EXPECT_EQ(round_trip(readout), readout);
    const TemperatureNote temperature{any.time(), static_cast<float>(any.integer())};
    EXPECT_EQ(round_trip(temperature), temperature);
  }
  EXPECT_EQ(round_trip(SensorNote{{}, {1, 1}, ""}).camera, "");
}

TEST(Convert, NotesOnACameraThatCannotBeAreRefused) {
  EXPECT_THROW(encode(SensorNote{{}, {0, 1}, ""}), std::invalid_argument);
  EXPECT_THROW(encode(SensorNote{{}, {1, 32768}, ""}), std::invalid_argument);
  for (const int type : {-1, 128})
    EXPECT_THROW(encode(TriggerNote{{}, type}), std::invalid_argument) << type;
  Bytes bytes = encode(SensorNote{{}, {1, 1}, "DAVIS"});
  bytes[24] = 0x7f;  // of the name's length
  EXPECT_THROW(decode<SensorNote>(bytes), std::invalid_argument);
}

TEST(Convert, TagDetectionsKeepEveryBit) {
  AnyValues any(4);
  for (std::size_t n = 0; n < 20; ++n) {
    TagDetections sent{any.time(), {}};
    while (sent.tags.size() < n) sent.tags.push_back(any.tag(sent.t));
    const TagDetections got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    ASSERT_EQ(got.tags.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(got.tags[i].t, sent.tags[i].t);
      EXPECT_EQ(got.tags[i].id, sent.tags[i].id);
      EXPECT_EQ(got.tags[i].hamming, sent.tags[i].hamming);
      EXPECT_TRUE(same(got.tags[i].decision_margin, sent.tags[i].decision_margin));
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_TRUE(same(got.tags[i].corner_px[k], sent.tags[i].corner_px[k]));
    }
  }
}

TEST(Convert, TagOfAnotherTimeThanItsPictureIsRefused) {
  AnyValues any(11);
  EXPECT_THROW(encode(TagDetections{6us, {any.tag(5us)}}), std::invalid_argument);
}

TEST(Convert, TargetEstimatesKeepEveryBit) {
  AnyValues any(5);
  for (int round = 0; round < kRounds; ++round) {
    const core::TargetEstimate sent{any.time(),   any.flag(),   any.vector(), any.vector(),
                                    any.number(), any.number(), any.vector(), any.time()};
    const core::TargetEstimate got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    EXPECT_EQ(got.valid, sent.valid);
    EXPECT_TRUE(same(got.p_world_tag_m, sent.p_world_tag_m));
    EXPECT_TRUE(same(got.v_world_tag_m_s, sent.v_world_tag_m_s));
    EXPECT_TRUE(same(got.heading_rad, sent.heading_rad));
    EXPECT_TRUE(same(got.turn_rate_rad_s, sent.turn_rate_rad_s));
    EXPECT_TRUE(same(got.sigma_p_m, sent.sigma_p_m));
    EXPECT_EQ(got.last_tag, sent.last_tag);
  }
}

TEST(Convert, VehicleStatesKeepEveryBit) {
  AnyValues any(6);
  for (int round = 0; round < kRounds; ++round) {
    const core::VehicleState sent = any.vehicle_state();
    EXPECT_TRUE(same(round_trip(sent), sent));
  }
}

TEST(Convert, AttitudeSetpointsKeepEveryBit) {
  AnyValues any(7);
  for (int round = 0; round < kRounds; ++round) {
    const core::AttitudeSetpoint sent{any.time(), any.quaternion(), any.number(), any.flag()};
    const core::AttitudeSetpoint got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    EXPECT_TRUE(same(got.q_world_body, sent.q_world_body));
    EXPECT_TRUE(same(got.thrust_m_s2, sent.thrust_m_s2));
    EXPECT_EQ(got.motors_on, sent.motors_on);
  }
}

TEST(Convert, MissionTransitionsKeepEveryPhaseAndCause) {
  using enum core::MissionPhase;
  for (const core::MissionPhase from : {search, track, descend, land, touched_down})
    for (const core::MissionPhase to : {search, track, descend, land, touched_down})
      for (const std::string& cause :
           {std::string(), std::string("tag lost for 0.5 s, µ"), std::string(100'000, 'x')}) {
        const core::MissionTransition got =
            round_trip(core::MissionTransition{kLast, from, to, cause});
        EXPECT_EQ(got.t, kLast);
        EXPECT_EQ(got.from, from);
        EXPECT_EQ(got.to, to);
        EXPECT_EQ(got.cause, cause);
      }
}

TEST(Convert, TextWithAZeroByteIsRefused) {
  core::MissionTransition transition;
  transition.cause = std::string("lost\0tag", 8);
  EXPECT_THROW(encode(transition), std::invalid_argument);
}

TEST(Convert, TruthKeepsEveryBit) {
  AnyValues any(8);
  for (int round = 0; round < kRounds; ++round) {
    const core::Truth sent{any.time(),   any.vehicle_state(), any.transform(), any.transform(),
                           any.vector(), any.number(),        "turning",       any.flag(),
                           any.flag(),   any.flag()};
    const core::Truth got = round_trip(sent);
    EXPECT_EQ(got.t, sent.t);
    EXPECT_TRUE(same(got.uav, sent.uav));
    EXPECT_TRUE(same(got.T_world_camera, sent.T_world_camera));
    EXPECT_TRUE(same(got.T_world_tag, sent.T_world_tag));
    EXPECT_TRUE(same(got.v_world_tag_m_s, sent.v_world_tag_m_s));
    EXPECT_TRUE(same(got.turn_rate_rad_s, sent.turn_rate_rad_s));
    EXPECT_EQ(got.course_phase, sent.course_phase);
    EXPECT_EQ(got.on_board, sent.on_board);
    EXPECT_EQ(got.crashed, sent.crashed);
    EXPECT_EQ(got.ugv_collided, sent.ugv_collided);
  }
}

TEST(Convert, EveryMessageHoldsItsTimeFirst) {
  const core::Time t = 123'456'789'012us;
  core::ImuSample imu;
  core::TargetEstimate estimate;
  core::VehicleState state;
  core::AttitudeSetpoint setpoint;
  core::MissionTransition transition;
  core::Truth truth;
  imu.t = estimate.t = state.t = setpoint.t = transition.t = truth.t = t;
  for (const Bytes& bytes :
       {encode(core::EventPacket{t - 10ms, t, {}}), encode(core::Picture{t, {}}),
        encode(core::ApsFrame{t - 500ms, t, 10, {}}), encode(imu), encode(TagDetections{t, {}}),
        encode(estimate), encode(state), encode(setpoint), encode(transition), encode(truth)})
    EXPECT_EQ(message_time(bytes), t);
  EXPECT_THROW(message_time(Bytes(15)), std::invalid_argument);
}

/// One small but not empty message of each type, with its decoder.
struct Sample {
  const char* name;
  Bytes bytes;
  std::function<void(std::span<const std::uint8_t>)> decode;
};

template <class T>
Sample sample(const char* name, const T& value) {
  return {name, encode(value),
          [](std::span<const std::uint8_t> bytes) { (void)msg::decode<T>(bytes); }};
}

std::vector<Sample> samples() {
  AnyValues any(9);
  return {sample("events", core::EventPacket{0us, 9us, {{1us, 2, 3, true}, {4us, 5, 6, false}}}),
          sample("picture", core::Picture{1us, any.image({4, 3})}),
          sample("aps_frame", any.frame({4, 3}, 10)),
          sample("imu_sample", core::ImuSample{}),
          sample("tag_detections", TagDetections{1us, {any.tag(1us), any.tag(1us)}}),
          sample("target_estimate", core::TargetEstimate{}),
          sample("vehicle_state", core::VehicleState{}),
          sample("attitude_setpoint", core::AttitudeSetpoint{}),
          sample("mission_transition", core::MissionTransition{0us, {}, {}, "tag seen"}),
          sample("truth", core::Truth{})};
}

TEST(Convert, MessagesCutShortOrTooLongAreRefused) {
  for (const Sample& s : samples()) {
    SCOPED_TRACE(s.name);
    for (std::size_t size = 0; size < s.bytes.size(); ++size)
      EXPECT_THROW(s.decode(std::span(s.bytes).first(size)), std::invalid_argument) << size;
    Bytes longer = s.bytes;
    longer.push_back(0);
    EXPECT_THROW(s.decode(longer), std::invalid_argument);
  }
}

TEST(Convert, MessagesOfAnotherTypeAreRefused) {
  const std::vector<Sample> all = samples();
  for (const Sample& reader : all)
    for (const Sample& message : all)
      if (reader.name != message.name) {
        EXPECT_THROW(reader.decode(message.bytes), std::invalid_argument)
            << message.name << " read as " << reader.name;
      }
}

TEST(Convert, ChangedBytesAreReadOrRefusedButDoNoHarm) {
  for (const Sample& s : samples())
    for (std::size_t at = 8; at < s.bytes.size(); ++at)
      for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
        Bytes changed = s.bytes;
        changed[at] = static_cast<std::uint8_t>(value);
        try {
          s.decode(changed);
        } catch (const std::invalid_argument&) {  // the only exception promised
        }
      }
}

TEST(Convert, CountsThatDisagreeWithTheSizeAreRefused) {
  AnyValues any(10);
  Bytes picture = encode(core::Picture{1us, any.image({4, 3})});
  picture[19] = 3;  // lowest byte of width_px: 3 x 3 px, but 12 bytes
  EXPECT_THROW(decode<core::Picture>(picture), std::invalid_argument);
  Bytes events = encode(core::EventPacket{0us, 9us, {{1us, 2, 3, true}}});
  events[24] = 0x7f;  // highest byte of n: two thousand million events
  EXPECT_THROW(decode<core::EventPacket>(events), std::invalid_argument);
  events[24] = 0xff;  // and a negative number of them
  EXPECT_THROW(decode<core::EventPacket>(events), std::invalid_argument);
}

TEST(Convert, UnknownPhaseIsRefused) {
  Bytes bytes = encode(core::MissionTransition{0us, {}, core::MissionPhase::land, ""});
  const std::string text(bytes.begin(), bytes.end());
  bytes[text.find("land")] = 'h';
  EXPECT_THROW(decode<core::MissionTransition>(bytes), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::msg
