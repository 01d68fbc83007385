#include "esi/onnx_signature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "core/random.h"
#include "tests/support/tiny_network.h"

namespace nightjar::esi {
namespace {

std::vector<std::uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

test::Message tensor(const std::string& name, const test::Message& sides) {
  const test::Message type = test::Message().number(1, 1).message(2, sides);
  return test::Message().bytes(1, name).message(2, test::Message().message(1, type));
}

test::Message side(std::uint64_t value) {
  return test::Message().message(1, test::Message().number(1, value));
}

TEST(OnnxSignatureTest, tells_names_and_shapes_but_not_weights) {
  const test::Message open = test::Message().message(1, test::Message().bytes(2, "height"));
  const test::Message graph = test::Message()
                                  .message(11, tensor("voxels", side(300)))
                                  .message(11, tensor("kernel", side(3)))
                                  .message(5, test::Message().bytes(8, "kernel"))
                                  .message(12, tensor("image", open));
  const OnnxSignature signature =
      read_onnx_signature(bytes(test::Message().number(1, 7).message(7, graph).text()));
  ASSERT_EQ(signature.inputs.size(), 1u);
  EXPECT_EQ(signature.inputs[0], (OnnxTensor{"voxels", {300}}));
  ASSERT_EQ(signature.outputs.size(), 1u);
  EXPECT_EQ(to_string(signature.outputs[0]), "image ?");
  EXPECT_EQ(to_string({"voxels", {1, 5, 0, 7}}), "voxels 1x5x?x7");
}

TEST(OnnxSignatureTest, refuses_bytes_that_are_no_network) {
  EXPECT_THROW(read_onnx_signature({}), std::invalid_argument);
  EXPECT_THROW(read_onnx_signature(bytes("# a text file")), std::invalid_argument);
  // A graph said to be longer than the file.
  EXPECT_THROW(read_onnx_signature(bytes("\x3a\x7f"
                                         "abc")),
               std::invalid_argument);
  // A length of eleven bytes, one more than 64 bits take.
  EXPECT_THROW(read_onnx_signature(bytes("\x3a" + std::string(11, '\xff'))), std::invalid_argument);
}

TEST(OnnxSignatureTest, takes_any_bytes_without_harm) {
  // A sound file with bytes changed at random: read or refused, nothing else.
  core::Random random = core::random_stream(/*seed=*/3, "test.onnx");
  const test::Message graph = test::Message()
                                  .message(11, tensor("voxels", side(300)))
                                  .message(12, tensor("image", side(5)));
  const auto sound = bytes(test::Message().message(7, graph).text());
  for (int i = 0; i < 20000; ++i) {
    auto file = sound;
    for (int k = 0; k < 3; ++k) file[random() % file.size()] = static_cast<std::uint8_t>(random());
    file.resize(random() % (file.size() + 1));
    try {
      for (const OnnxTensor& each : read_onnx_signature(file).inputs)
        EXPECT_TRUE(std::ranges::all_of(each.shape, [](auto s) { return s >= 0; }));
    } catch (const std::invalid_argument&) {
    }
  }
}

}  // namespace
}  // namespace nightjar::esi
