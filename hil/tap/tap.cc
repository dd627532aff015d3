#include "hil/tap/tap.h"

#include <algorithm>
#include <utility>

namespace omnihil {
namespace {

constexpr std::size_t kAtOnce = 4096;  // bytes of one read: several packets of any format

}  // namespace

Tap::Tap(std::unique_ptr<ByteWire> host, std::unique_ptr<ByteWire> dongle, SessionObserver* recorder,
         std::int64_t step_ns)
    : host_{std::move(host), {}}, dongle_{std::move(dongle), {}}, recorder_(recorder), step_ns_(step_ns) {}

bool Tap::lost(const End& end, const std::error_code& error) {
  problem_ = std::string(end.wire->name()) + ": " + error.message();
  return false;
}

bool Tap::take(End& from, End& to, std::int64_t now_ns, bool from_host) {
  if (to.waiting.size() >= kMostWaiting) return true;  // the sender's own port fills up and stops it
  read_.clear();
  if (const std::error_code error = from.wire->read(read_, kAtOnce)) return lost(from, error);
  if (read_.empty()) return true;
  moved_ = true;
  if (recorder_ != nullptr) {
    recorded_ns_ = std::max(recorded_ns_, from_host ? next_step_ns(now_ns) : now_ns);
    if (from_host) {
      recorder_->host_bytes(recorded_ns_, read_);
    } else {
      recorder_->dongle_bytes(recorded_ns_, read_);
    }
  }
  to.waiting.insert(to.waiting.end(), read_.begin(), read_.end());
  counts_.most_waiting = std::max<std::uint64_t>(counts_.most_waiting, to.waiting.size());
  return true;
}

bool Tap::give(End& to, std::uint64_t& passed) {
  if (to.waiting.empty()) return true;
  if (!to.wire->peer_present()) {
    counts_.without_host += to.waiting.size();
    to.waiting.clear();
    return true;
  }
  std::error_code error;
  const std::size_t sent = to.wire->write(to.waiting, error);
  if (error) return lost(to, error);
  passed += sent;
  to.waiting.erase(to.waiting.begin(), to.waiting.begin() + static_cast<std::ptrdiff_t>(sent));
  return true;
}

bool Tap::pass(std::int64_t now_ns) {
  moved_ = false;
  if (!take(host_, dongle_, now_ns, true) || !give(dongle_, counts_.to_dongle)) return false;
  if (host_.wire->take_peer_closed()) {
    ++counts_.host_left;
    recorded_ns_ = std::max(recorded_ns_, next_step_ns(now_ns));
    if (recorder_ != nullptr) recorder_->host_closed(recorded_ns_);
  }
  return take(dongle_, host_, now_ns, false) && give(host_, counts_.to_host);
}

}  // namespace omnihil
