#include "hil/text/sha256.h"

#include <openssl/evp.h>

#include <array>
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

struct Sha256::Impl {
  Context context = new_context();
};

Sha256::Sha256() : impl_(std::make_unique<Impl>()) {
  must(EVP_DigestInit_ex(impl_->context.get(), EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::uint8_t> bytes) {
  must(EVP_DigestUpdate(impl_->context.get(), bytes.data(), bytes.size()));
}

void Sha256::add(std::string_view text) {
  must(EVP_DigestUpdate(impl_->context.get(), text.data(), text.size()));
}

std::string Sha256::hex() const {
  const Context copy = new_context();
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  must(EVP_MD_CTX_copy_ex(copy.get(), impl_->context.get()));
  must(EVP_DigestFinal_ex(copy.get(), digest.data(), &size));
  return to_hex(std::span(digest).first(size));
}

std::string sha256_of(std::string_view text) {
  Sha256 hash;
  hash.add(text);
  return hash.hex();
}

}  // namespace omnihil
