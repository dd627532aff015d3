#include "hil/firmware/avr_memory.h"

#include <algorithm>

namespace omnihil {
std::optional<AvrBytes> AvrMemory::place_of(const MemoryPiece& piece) {
  if (piece.space != MemorySpace::kImage || piece.address < mcu::kAvrData ||
      piece.address > mcu::kAvrEeprom || piece.bytes > mcu::kAvrEeprom - piece.address)
    return std::nullopt;
  return AvrBytes{static_cast<std::uint32_t>(piece.address - mcu::kAvrData),
                  static_cast<std::uint32_t>(piece.bytes)};
}

bool AvrMemory::read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) {
  asked_.assign(boards_.size(), {});
  answers_.assign(boards_.size(), {});
  for (const MemoryPiece& piece : pieces) {
    const auto place = place_of(piece);
    if (!place || piece.board >= boards_.size()) return false;
    asked_[piece.board].push_back(*place);
  }
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    if (!asked_[b].empty()) boards_[b]->ask(asked_[b]);
  }
  bool there = true;
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    if (!asked_[b].empty()) there = boards_[b]->read(answers_[b]) && there;
  }
  std::vector<std::size_t> taken(boards_.size(), 0);
  for (const MemoryPiece& piece : pieces) {
    const auto& from = answers_[piece.board];
    std::size_t& at = taken[piece.board];
    if (!there || piece.bytes > out.size() || piece.bytes > from.size() - at) return false;
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), piece.bytes, out.begin());
    at += piece.bytes;
    out = out.subspan(piece.bytes);
  }
  return true;
}

bool AvrMemory::write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) {
  const auto place = place_of(piece);
  return place && piece.board < boards_.size() && boards_[piece.board]->write(place->address, bytes);
}

void AvrMemory::when_started(std::function<void()> work) {
  if (!main_ || started_ == boards_.size()) return work();
  if (waiting_.empty()) {
    for (const auto& board : boards_) board->pause_at(*main_);
  }
  waiting_.push_back(std::move(work));
}

void AvrMemory::finish_all() {
  std::vector<AvrBoard*> paused;
  for (const auto& board : boards_) {
    if (!board->finish()) paused.push_back(board.get());
  }
  if (paused.empty()) return;
  started_ += paused.size();
  if (started_ == boards_.size()) {
    for (const auto& work : waiting_) work();
    waiting_.clear();
  }
  for (AvrBoard* board : paused) board->go_on();
  for (AvrBoard* board : paused) board->finish();
}

}  // namespace omnihil
