#include "camera/packet_compression.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace nightjar::camera {
namespace {

constexpr int kZstdWindowLog = 26;  // 64 MiB, as large as a packet may be
constexpr int kZstdLevel = 3, kZstdHighLevel = 15;
constexpr int kLz4Level = 0, kLz4HighLevel = 9;

[[noreturn]] void fail(const char* kind, const std::string& why) {
  throw std::invalid_argument(fmt::format("packed with {}: {}", kind, why));
}

/// Takes from the front of `in`, writes to `out`, says how much of both, and whether the
/// frame is complete.
struct Step {
  std::size_t taken = 0;
  std::size_t written = 0;
  bool done = false;
};

/// Calls `step(in, out)` with room that grows as it is needed, until the frame is complete.
template <class StepFunction>
void unpack(const char* kind, std::span<const std::byte> in, std::vector<std::byte>& out,
            StepFunction step) {
  std::size_t filled = 0;
  out.resize(std::clamp(in.size() * 4, std::size_t{4096}, kMostPacketBytes));
  for (;;) {
    const Step made = step(in, std::span(out).subspan(filled));
    in = in.subspan(made.taken);
    filled += made.written;
    if (made.done) break;
    if (filled == out.size()) {
      if (filled == kMostPacketBytes)
        fail(kind, fmt::format("more than {} bytes", kMostPacketBytes));
      out.resize(std::min(out.size() * 2, kMostPacketBytes));
    } else if (in.empty()) {
      fail(kind, "ends early");
    }
  }
  if (!in.empty()) fail(kind, fmt::format("{} bytes after its end", in.size()));
  out.resize(filled);
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

void decompress_lz4(std::span<const std::byte> packed, std::vector<std::byte>& out) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(made);
  unpack("LZ4", packed, out, [&](auto in, auto room) {
    Step step{in.size(), room.size(), false};
    const std::size_t hint =
        LZ4F_decompress(context.get(), room.data(), &step.written, in.data(), &step.taken, nullptr);
    if (LZ4F_isError(hint)) fail("LZ4", LZ4F_getErrorName(hint));
    step.done = hint == 0;
    return step;
  });
}

struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

void decompress_zstd(std::span<const std::byte> packed, std::vector<std::byte>& out) {
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kZstdWindowLog);
  unpack("ZSTD", packed, out, [&](auto in, auto room) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{room.data(), room.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(context.get(), &output, &input);
    if (ZSTD_isError(hint)) fail("ZSTD", ZSTD_getErrorName(hint));
    return Step{input.pos, output.pos, hint == 0};
  });
}

std::vector<std::byte> compress_lz4(std::span<const std::byte> plain, int level) {
  LZ4F_preferences_t preferences{};
  preferences.compressionLevel = level;
  preferences.frameInfo.contentSize = plain.size();
  std::vector<std::byte> packed(LZ4F_compressFrameBound(plain.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), &preferences);
  if (LZ4F_isError(size)) throw std::runtime_error(LZ4F_getErrorName(size));
  packed.resize(size);
  return packed;
}

std::vector<std::byte> compress_zstd(std::span<const std::byte> plain, int level) {
  std::vector<std::byte> packed(ZSTD_compressBound(plain.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), level);
  if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace

void decompress(std::span<const std::byte> packed, Compression compression,
                std::vector<std::byte>& out) {
  switch (compression) {
    case Compression::none: out.assign(packed.begin(), packed.end()); return;
    case Compression::lz4:
    case Compression::lz4_high: decompress_lz4(packed, out); return;
    case Compression::zstd:
    case Compression::zstd_high: decompress_zstd(packed, out); return;
  }
}

std::vector<std::byte> compress(std::span<const std::byte> plain, Compression compression) {
  switch (compression) {
    case Compression::none: break;
    case Compression::lz4: return compress_lz4(plain, kLz4Level);
    case Compression::lz4_high: return compress_lz4(plain, kLz4HighLevel);
    case Compression::zstd: return compress_zstd(plain, kZstdLevel);
    case Compression::zstd_high: return compress_zstd(plain, kZstdHighLevel);
  }
  return {plain.begin(), plain.end()};
}

}  // namespace nightjar::camera
