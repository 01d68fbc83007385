#include "esi/onnx_signature.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace nightjar::esi {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// One field of a protobuf message: a whole number or bytes, whichever its kind has.
struct Field {
  std::uint64_t number = 0;
  std::uint64_t whole = 0;
  Bytes bytes;
};

[[noreturn]] void fail() { throw std::invalid_argument("is no ONNX network"); }

Bytes take(Bytes& rest, std::uint64_t count) {
  if (count > rest.size()) fail();
  const Bytes taken = rest.first(static_cast<std::size_t>(count));
  rest = rest.subspan(static_cast<std::size_t>(count));
  return taken;
}

std::uint64_t take_varint(Bytes& rest) {
  constexpr int kMostBits = 64;
  std::uint64_t value = 0;
  for (int shift = 0; shift < kMostBits; shift += 7) {
    const std::uint8_t byte = take(rest, 1)[0];
    value |= std::uint64_t{byte & 0x7fu} << shift;
    if ((byte & 0x80u) == 0) return value;
  }
  fail();
}

// https://protobuf.dev/programming-guides/encoding
Field take_field(Bytes& rest) {
  enum WireType { varint = 0, bits_64 = 1, sized = 2, bits_32 = 5 };
  const std::uint64_t key = take_varint(rest);
  Field field{.number = key >> 3, .whole = 0, .bytes = {}};
  switch (key & 7) {
    case varint: field.whole = take_varint(rest); break;
    case bits_64: take(rest, 8); break;
    case sized: field.bytes = take(rest, take_varint(rest)); break;
    case bits_32: take(rest, 4); break;
    default: fail();
  }
  return field;
}

/// Calls `see` for each field of the message with that number.
template <class See>
void each(Bytes message, std::uint64_t number, See see) {
  while (!message.empty()) {
    const Field field = take_field(message);
    if (field.number == number) see(field);
  }
}

std::string text_of(Bytes message, std::uint64_t number) {
  std::string text;
  each(message, number, [&](const Field& f) { text.assign(f.bytes.begin(), f.bytes.end()); });
  return text;
}

// Field numbers of onnx.proto3.
OnnxTensor tensor_of(Bytes value_info) {
  constexpr int kName = 1, kType = 2, kTensorType = 1, kShape = 2, kDim = 1, kDimValue = 1;
  OnnxTensor tensor{.name = text_of(value_info, kName), .shape = {}};
  each(value_info, kType, [&](const Field& type) {
    each(type.bytes, kTensorType, [&](const Field& tensor_type) {
      each(tensor_type.bytes, kShape, [&](const Field& shape) {
        each(shape.bytes, kDim, [&](const Field& dim) {
          std::int64_t side = 0;
          each(dim.bytes, kDimValue,
               [&](const Field& f) { side = static_cast<std::int64_t>(f.whole); });
          tensor.shape.push_back(std::max<std::int64_t>(side, 0));
        });
      });
    });
  });
  return tensor;
}

}  // namespace

std::string to_string(const OnnxTensor& tensor) {
  std::vector<std::string> sides;
  for (const std::int64_t side : tensor.shape)
    sides.push_back(side > 0 ? std::to_string(side) : "?");
  return fmt::format("{} {}", tensor.name, fmt::join(sides, "x"));
}

OnnxSignature read_onnx_signature(Bytes file) {
  constexpr int kGraph = 7, kInitializer = 5, kInput = 11, kOutput = 12, kTensorName = 8;
  OnnxSignature signature;
  each(file, kGraph, [&](const Field& graph) {
    std::set<std::string> weights;  // older files list them among the inputs
    each(graph.bytes, kInitializer,
         [&](const Field& f) { weights.insert(text_of(f.bytes, kTensorName)); });
    each(graph.bytes, kInput, [&](const Field& f) {
      OnnxTensor tensor = tensor_of(f.bytes);
      if (!weights.contains(tensor.name)) signature.inputs.push_back(std::move(tensor));
    });
    each(graph.bytes, kOutput,
         [&](const Field& f) { signature.outputs.push_back(tensor_of(f.bytes)); });
  });
  if (signature.inputs.empty() || signature.outputs.empty()) fail();
  return signature;
}

}  // namespace nightjar::esi
