#include "hil/recording/replay_hash.h"

#include <bit>

#include "hil/text/sha256.h"

namespace omnihil {

struct OutputHash::Impl {
  Sha256 hash;
  std::vector<std::uint8_t> row;  // what one event adds

  void number(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) row.push_back(static_cast<std::uint8_t>(value >> shift));
  }
  void begin(char tag, std::int64_t now_ns) {
    row.clear();
    row.push_back(static_cast<std::uint8_t>(tag));
    number(static_cast<std::uint64_t>(now_ns));
  }
  void end() { hash.add(row); }
};

OutputHash::OutputHash() : impl_(std::make_unique<Impl>()) {}

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

std::string OutputHash::hex() const { return impl_->hash.hex(); }

}  // namespace omnihil
