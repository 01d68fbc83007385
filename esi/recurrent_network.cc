#include "esi/recurrent_network.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <stdexcept>
#include <system_error>

#include "esi/onnx_signature.h"
#include "esi/voxel_grid.h"

namespace nightjar::esi {
namespace {

using Shape = std::vector<int>;

constexpr std::uint8_t kMidGray = 128;

/// OpenCV prints what it also throws.
class Silence {
 public:
  Silence() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~Silence() { cv::utils::logging::setLogLevel(before_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(path, ignored))
    throw std::invalid_argument("cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string state_name(std::size_t i, const char* end) { return fmt::format("state{}_{}", i, end); }

const OnnxTensor* find(const std::vector<OnnxTensor>& tensors, const std::string& name) {
  const auto found = std::ranges::find(tensors, name, &OnnxTensor::name);
  return found == tensors.end() ? nullptr : &*found;
}

std::string list(const std::vector<OnnxTensor>& tensors) {
  std::vector<std::string> texts;
  for (const OnnxTensor& tensor : tensors) texts.push_back(to_string(tensor));
  return fmt::format("{}", fmt::join(texts, ", "));
}

[[noreturn]] void refuse_tensors(const OnnxSignature& has) {
  throw std::invalid_argument(fmt::format(
      "its inputs are {} and its outputs {}, expected voxels 1x{}xHxW, state0_in, ... and image "
      "1x1xHxW, state0_out, ...",
      list(has.inputs), list(has.outputs), VoxelGrid::kBins));
}

/// What of the file's shapes holds at any size.
struct Layout {
  struct State {
    int channels = 0;
    int shrink = 1;  ///< The voxels' sides over the state's.
  };
  std::vector<State> states;
  int multiple_px = 1;  ///< Of which the voxels' sides are.
};

bool is_plane(const OnnxTensor* tensor) {
  constexpr std::int64_t kMost = core::kMostSide_px;
  return tensor != nullptr && tensor->shape.size() == 4 && tensor->shape[0] == 1 &&
         std::ranges::all_of(tensor->shape, [](auto side) { return side >= 1 && side <= kMost; });
}

Layout layout_of(const OnnxSignature& has) {
  const OnnxTensor* voxels = find(has.inputs, "voxels");
  const std::size_t states = has.inputs.size() - 1;
  if (!is_plane(voxels) || voxels->shape[1] != VoxelGrid::kBins || !find(has.outputs, "image") ||
      has.outputs.size() != has.inputs.size())
    refuse_tensors(has);
  Layout layout;
  for (std::size_t i = 0; i < states; ++i) {
    const OnnxTensor* state = find(has.inputs, state_name(i, "in"));
    if (!is_plane(state) || !find(has.outputs, state_name(i, "out"))) refuse_tensors(has);
    const std::int64_t shrink = voxels->shape[2] / state->shape[2];
    if (shrink < 1 || state->shape[2] * shrink != voxels->shape[2] ||
        state->shape[3] * shrink != voxels->shape[3])
      refuse_tensors(has);
    layout.states.push_back({static_cast<int>(state->shape[1]), static_cast<int>(shrink)});
    layout.multiple_px = std::lcm(layout.multiple_px, layout.states.back().shrink);
  }
  return layout;
}

int grown(int side_px, int multiple_px) {
  return (side_px + multiple_px - 1) / multiple_px * multiple_px;
}

/// Grey levels from those that 1 % and 99 % of the picture lie below, as E2VID shows them.
std::pair<float, float> range_of(std::vector<float> values) {
  const auto at = [&](std::size_t percent) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() * percent / 100);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const float least = at(1), greatest = at(99);
  return {least, greatest};
}

}  // namespace

/// The network at one size, with its memory.
struct RecurrentNetwork::Net {
  Net(const std::string& file, core::Resolution size);

  void reset();
  /// One step: the voxels of `grid` in, `image` and the next states out.
  void run();

  cv::dnn::Net net;
  VoxelGrid grid;
  cv::Mat image;
  std::vector<cv::Mat> states;
  std::vector<Shape> state_shapes;
  std::vector<cv::String> output_names{"image"};

 private:
  void load(const std::vector<std::uint8_t>& file, const Layout& layout);
};

RecurrentNetwork::Net::Net(const std::string& file, core::Resolution size) {
  const std::vector<std::uint8_t> bytes = read_file(file);
  const Layout layout = layout_of(read_onnx_signature(bytes));
  grid.size = {grown(size.width_px, layout.multiple_px), grown(size.height_px, layout.multiple_px)};
  const Silence silence;
  try {
    load(bytes, layout);
    reset();
    fill_voxel_grid({}, size, grid);
    run();  // OpenCV finds out only now whether all shapes fit
  } catch (const cv::Exception& error) {
    throw std::invalid_argument(fmt::format("OpenCV {} cannot run it at {}x{}: {}", CV_VERSION,
                                            grid.size.width_px, grid.size.height_px, error.err));
  }
  reset();
}

void RecurrentNetwork::Net::load(const std::vector<std::uint8_t>& file, const Layout& layout) {
  net = cv::dnn::readNetFromONNX(file);
  const int height = grid.size.height_px, width = grid.size.width_px;
  net.setInputShape("voxels", {1, VoxelGrid::kBins, height, width});
  for (std::size_t i = 0; i < layout.states.size(); ++i) {
    const auto [channels, shrink] = layout.states[i];
    state_shapes.push_back({1, channels, height / shrink, width / shrink});
    net.setInputShape(state_name(i, "in"), state_shapes.back());
    output_names.push_back(state_name(i, "out"));
  }
}

void RecurrentNetwork::Net::reset() {
  states.clear();
  for (const Shape& shape : state_shapes) states.emplace_back(shape, CV_32F, cv::Scalar(0));
}

void RecurrentNetwork::Net::run() {
  const Shape shape{1, VoxelGrid::kBins, grid.size.height_px, grid.size.width_px};
  net.setInput(cv::Mat(shape, CV_32F, grid.values.data()), "voxels");
  for (std::size_t i = 0; i < states.size(); ++i) net.setInput(states[i], state_name(i, "in"));
  std::vector<cv::Mat> out;
  net.forward(out, output_names);
  const auto has = [](const cv::Mat& mat, const Shape& wanted) {
    return mat.type() == CV_32F && Shape(mat.size.p, mat.size.p + mat.dims) == wanted;
  };
  bool fits = has(out[0], {1, 1, grid.size.height_px, grid.size.width_px});
  for (std::size_t i = 0; i < states.size(); ++i) fits = fits && has(out[i + 1], state_shapes[i]);
  if (!fits) CV_Error(cv::Error::StsUnmatchedSizes, "an output's shape is not that of its input");
  image = out[0].clone();  // the network writes to its own again
  for (std::size_t i = 0; i < states.size(); ++i) states[i] = out[i + 1].clone();
}

RecurrentNetwork::RecurrentNetwork(const std::string& name, const NetworkConfig& config,
                                   core::Resolution size)
    : Reconstructor(size), config_(config) {
  core::check_config(config, name);
  if (config.weights.empty())
    throw std::invalid_argument(
        fmt::format("{0} needs weights: reconstructor.{0}.weights = FILE.onnx", name));
  try {
    net_ = std::make_unique<Net>(config.weights, size);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", config.weights, error.what()));
  }
  reset();
}

RecurrentNetwork::~RecurrentNetwork() = default;

void RecurrentNetwork::clear(core::Time) {
  net_->reset();
  events_.clear();
  picture_ = core::Image<std::uint8_t>(size(), kMidGray);
}

void RecurrentNetwork::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  limit_times(events_, now_us, most_us);
}

void RecurrentNetwork::integrate(std::span<const PackedEvent> events) {
  if (events_.size() >= 2 * kMostEvents)
    events_.erase(events_.begin(), events_.end() - kMostEvents);
  events_.insert(events_.end(), events.begin(), events.end());
}

void RecurrentNetwork::advance() {
  const std::span<const PackedEvent> all = events_;
  fill_voxel_grid(all.last(std::min(all.size(), kMostEvents)), size(), net_->grid);
  if (config_.normalise) normalise(net_->grid);
  net_->run();
  events_.clear();
}

void RecurrentNetwork::draw(core::Time, core::Image<std::uint8_t>& gray) {
  if (!events_.empty()) {
    advance();
    std::vector<float> values;
    for (int y = 0; y < size().height_px; ++y) {
      const float* row = net_->image.ptr<float>(0, 0) + y * net_->grid.size.width_px;
      values.insert(values.end(), row, row + size().width_px);
    }
    const auto [least, greatest] = config_.stretch ? range_of(values) : std::pair(0.0f, 1.0f);
    const float scale = 255.0f / std::max(greatest - least, 1e-6f);
    std::ranges::transform(values, picture_.pixels().begin(), [&](float value) {
      return static_cast<std::uint8_t>(std::clamp((value - least) * scale + 0.5f, 0.0f, 255.0f));
    });
  }
  gray = picture_;
}

}  // namespace nightjar::esi
