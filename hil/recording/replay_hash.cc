#include "hil/recording/replay_hash.h"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <stdexcept>

#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};
using Context = std::unique_ptr<EVP_MD_CTX, FreeContext>;

Context new_context() {
  Context context(EVP_MD_CTX_new());
  if (!context) throw std::runtime_error("SHA-256: no memory");
  return context;
}

void must(int ok) {
  if (ok != 1) throw std::runtime_error("SHA-256: the cryptographic library refused");
}

}  // namespace

struct OutputHash::Impl {
  Context context = new_context();
  std::vector<std::uint8_t> row;  // what one event adds

  void number(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) row.push_back(static_cast<std::uint8_t>(value >> shift));
  }
  void begin(char tag, std::int64_t now_ns) {
    row.clear();
    row.push_back(static_cast<std::uint8_t>(tag));
    number(static_cast<std::uint64_t>(now_ns));
  }
  void end() { must(EVP_DigestUpdate(context.get(), row.data(), row.size())); }
};

OutputHash::OutputHash() : impl_(std::make_unique<Impl>()) {
  must(EVP_DigestInit_ex(impl_->context.get(), EVP_sha256(), nullptr));
}

OutputHash::~OutputHash() = default;

void OutputHash::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  impl_->begin('<', now_ns);
  impl_->number(bytes.size());
  impl_->row.insert(impl_->row.end(), bytes.begin(), bytes.end());
  impl_->end();
}

void OutputHash::robot_tick(std::int64_t now_ns, const RobotSample& sample) {
  impl_->begin('s', now_ns);
  impl_->number(static_cast<std::uint64_t>(sample.robot_id));
  for (const SampleColumn& column : sample_columns()) {
    impl_->number(std::bit_cast<std::uint64_t>(column.get(sample)));
  }
  impl_->end();
}

std::string OutputHash::hex() const {
  const Context copy = new_context();
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  must(EVP_MD_CTX_copy_ex(copy.get(), impl_->context.get()));
  must(EVP_DigestFinal_ex(copy.get(), digest.data(), &size));
  return to_hex(std::span(digest).first(size));
}

}  // namespace omnihil
