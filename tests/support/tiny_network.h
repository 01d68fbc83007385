#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/event.h"

namespace nightjar::test {

/// A protobuf message, field by field (https://protobuf.dev/programming-guides/encoding).
class Message {
 public:
  Message& number(int field, std::uint64_t value) {
    varint(static_cast<std::uint64_t>(field) << 3);
    varint(value);
    return *this;
  }
  Message& bytes(int field, const std::string& value) {
    varint(static_cast<std::uint64_t>(field) << 3 | 2);
    varint(value.size());
    text_ += value;
    return *this;
  }
  Message& message(int field, const Message& value) { return bytes(field, value.text_); }
  const std::string& text() const { return text_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) text_ += static_cast<char>((value & 0x7f) | 0x80);
    text_ += static_cast<char>(value);
  }

  std::string text_;
};

/// A recurrent network small enough to work out by hand, as an ONNX file. With v the sum of
/// a pixel's five voxels and s its state:
///     image = v / 4 + s / 2, next s = v + s / 2     (shrink = 1)
///     image = v / 4, next s = sum of v over 2x2 + s / 2     (shrink = 2)
struct TinyNetwork {
  core::Resolution size;
  int bins = 5;
  int shrink = 1;          ///< The voxels' sides over the state's.
  int state_channels = 1;  ///< As declared; the weights take one.
  std::string voxels = "voxels", state_in = "state0_in", state_out = "state0_out";

  /// Writes the file and returns its path.
  std::filesystem::path write(const std::filesystem::path& path) const {
    std::ofstream(path, std::ios::binary) << model().text();
    return path;
  }

 private:
  using Shape = std::vector<int>;

  // Field numbers are onnx.proto3's.
  static Message tensor_info(const std::string& name, const Shape& shape) {
    Message sides;
    for (const int side : shape) sides.message(1, Message().number(1, side));
    const Message tensor = Message().number(1, 1).message(2, sides);
    return Message().bytes(1, name).message(2, Message().message(1, tensor));
  }

  static Message weights(const std::string& name, const Shape& shape,
                         const std::vector<float>& values) {
    Message tensor;
    for (const int side : shape) tensor.number(1, side);
    std::string raw(values.size() * sizeof(float), '\0');
    std::memcpy(raw.data(), values.data(), raw.size());
    return tensor.number(2, 1).bytes(8, name).bytes(9, raw);
  }

  static Message integers(const char* name, const Shape& values) {
    Message attribute;
    attribute.bytes(1, name);
    for (const int value : values) attribute.number(8, value);
    return attribute.number(20, 7);
  }

  static Message node(const char* type, const std::vector<std::string>& in,
                      const std::string& out) {
    Message node;
    for (const std::string& name : in) node.bytes(1, name);
    return node.bytes(2, out).bytes(3, "make_" + out).bytes(4, type);
  }

  static Message conv(const std::string& in, const std::string& weights, const std::string& out,
                      int side) {
    return node("Conv", {in, weights}, out)
        .message(5, integers("kernel_shape", {side, side}))
        .message(5, integers("strides", {side, side}));
  }

  void add_small(Message& graph) const {
    std::vector<float> image(bins + 1, 0.25f), state(bins + 1, 1.0f);
    image.back() = state.back() = 0.5f;
    const Message axis = Message().bytes(1, "axis").number(3, 1).number(20, 2);
    graph.message(1, node("Concat", {voxels, state_in}, "all").message(5, axis))
        .message(1, conv("all", "image_weights", "image", 1))
        .message(1, conv("all", "state_weights", state_out, 1))
        .message(5, weights("image_weights", {1, bins + 1, 1, 1}, image))
        .message(5, weights("state_weights", {1, bins + 1, 1, 1}, state));
  }

  void add_shrinking(Message& graph) const {
    graph.message(1, conv(voxels, "image_weights", "image", 1))
        .message(1, conv(voxels, "sum_weights", "sum", 2))
        .message(1, conv(state_in, "half", "kept", 1))
        .message(1, node("Add", {"sum", "kept"}, state_out))
        .message(5, weights("image_weights", {1, bins, 1, 1}, std::vector<float>(bins, 0.25f)))
        .message(5, weights("sum_weights", {1, bins, 2, 2}, std::vector<float>(4 * bins, 1.0f)))
        .message(5, weights("half", {1, 1, 1, 1}, {0.5f}));
  }

  Message model() const {
    const int height = size.height_px, width = size.width_px;
    const Shape state{1, state_channels, height / shrink, width / shrink};
    Message graph;
    shrink == 1 ? add_small(graph) : add_shrinking(graph);
    graph.bytes(2, "tiny")
        .message(11, tensor_info(voxels, {1, bins, height, width}))
        .message(11, tensor_info(state_in, state))
        .message(12, tensor_info("image", {1, 1, height, width}))
        .message(12, tensor_info(state_out, state));
    const Message operators = Message().bytes(1, "").number(2, 11);
    return Message().number(1, 7).message(7, graph).message(8, operators);
  }
};

}  // namespace nightjar::test
