#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nightjar::esi {

/// A tensor that goes into a network or comes out of it.
struct OnnxTensor {
  std::string name;
  std::vector<std::int64_t> shape;  ///< 0 where the file leaves it open.

  friend bool operator==(const OnnxTensor&, const OnnxTensor&) = default;
};

/// "voxels 1x5x260x346", with ? for what is left open.
std::string to_string(const OnnxTensor& tensor);

struct OnnxSignature {
  std::vector<OnnxTensor> inputs;  ///< Without the weights.
  std::vector<OnnxTensor> outputs;
};

/// Reads the inputs and outputs of a network from the bytes of an ONNX file (onnx.proto3:
/// ModelProto, GraphProto, ValueInfoProto). Throws std::invalid_argument where the bytes
/// are not of that form.
OnnxSignature read_onnx_signature(std::span<const std::uint8_t> file);

}  // namespace nightjar::esi
