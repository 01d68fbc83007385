#include "scenarios/estimates_hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <bit>
#include <cstdint>
#include <stdexcept>

namespace nightjar::scenarios {
namespace {

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};
using Context = std::unique_ptr<EVP_MD_CTX, FreeContext>;

void check(bool done) {
  if (!done) throw std::runtime_error("SHA-256: OpenSSL failed");
}

}  // namespace

struct EstimatesHash::Impl {
  Context context{EVP_MD_CTX_new()};

  void add(std::uint64_t word) {
    std::array<unsigned char, sizeof(word)> bytes;
    for (unsigned char& byte : bytes) {
      byte = static_cast<unsigned char>(word);
      word >>= 8;
    }
    check(EVP_DigestUpdate(context.get(), bytes.data(), bytes.size()) == 1);
  }
  void add(core::Time t) { add(static_cast<std::uint64_t>(t.count())); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Eigen::Vector3d& v) {
    for (const double value : v) add(value);
  }
};

EstimatesHash::EstimatesHash() : impl_(std::make_unique<Impl>()) {
  check(impl_->context && EVP_DigestInit_ex(impl_->context.get(), EVP_sha256(), nullptr) == 1);
}

EstimatesHash::~EstimatesHash() = default;
EstimatesHash::EstimatesHash(EstimatesHash&&) noexcept = default;
EstimatesHash& EstimatesHash::operator=(EstimatesHash&&) noexcept = default;

void EstimatesHash::add(const core::TargetEstimate& estimate) {
  impl_->add(estimate.t);
  impl_->add(std::uint64_t{estimate.valid});
  impl_->add(estimate.p_world_tag_m);
  impl_->add(estimate.v_world_tag_m_s);
  impl_->add(estimate.heading_rad);
  impl_->add(estimate.turn_rate_rad_s);
  impl_->add(estimate.sigma_p_m);
  impl_->add(estimate.last_tag);
}

std::string EstimatesHash::hex() const {
  const Context copy(EVP_MD_CTX_new());  // finishing a digest ends it
  std::array<unsigned char, 32> digest;
  check(copy && EVP_MD_CTX_copy_ex(copy.get(), impl_->context.get()) == 1 &&
        EVP_DigestFinal_ex(copy.get(), digest.data(), nullptr) == 1);
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace nightjar::scenarios
