#include "hil/observe/image_profile.h"

#include <algorithm>

#include "hil/observe/call_tracker.h"

namespace omnihil {

// One board of one run.
class ImageProfile::Board final : public CallTracker {
 public:
  Board(ImageProfile& profile, mcu::Machine& machine, const mcu::ElfImage& image)
      : CallTracker(image, machine, [this](const CallEvent& event) { take(event); }),
        profile_(profile),
        machine_(machine) {
    machine.observe(this);
  }
  ~Board() override { machine_.observe(nullptr); }
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  void instruction(std::uint32_t pc, const mcu::Op& op, bool met, std::int64_t at) override {
    CallTracker::instruction(pc, op, met, at);
    if (met) count(pc);
    if (levels_.empty()) return;
    Level& level = levels_.back();
    level.lowest_sp = std::min(level.lowest_sp, machine_.cpu().reg.r[13]);
  }

  void end() {
    finish(static_cast<std::int64_t>(machine_.now()) * mcu::kSubcycles);
    for (std::size_t i = 0; i < functions().size(); ++i)
      profile_.functions_[functions()[i]].self += self()[i];
    profile_.asleep_ += asleep();
  }

 private:
  struct Level {
    std::int64_t begun;
    std::uint32_t sp, lowest_sp;
  };

  void count(std::uint32_t pc) {
    if (pc - begin_ >= bytes_) {
      auto after = profile_.counts_.upper_bound(pc);
      if (after == profile_.counts_.begin()) return;
      --after;
      if (pc - after->first >= 2 * after->second.size()) return;  // code that the image has put into RAM
      begin_ = after->first;
      bytes_ = static_cast<std::uint32_t>(2 * after->second.size());
      counts_ = after->second.data();
    }
    ++counts_[(pc - begin_) / 2];
  }

  void take(const CallEvent& event) {
    const auto name = [this](int function) {
      return function < 0 ? std::string() : functions()[static_cast<std::size_t>(function)];
    };
    switch (event.kind) {
      case CallEvent::Kind::kEnter:
        open_.push_back(event.which);
        ++profile_.functions_[name(event.which)].calls;
        break;
      case CallEvent::Kind::kLeave: {
        open_.pop_back();
        const bool again =
            std::ranges::find(open_, event.which) != open_.end();  // recursion: the outermost counts
        if (!again) profile_.functions_[name(event.which)].inclusive += event.own;
        if (event.caller < 0) break;
        CallCost& cost = profile_.calls_[{name(event.caller), name(event.which)}];
        ++cost.calls;
        if (!again) cost.inclusive += event.own;
        break;
      }
      case CallEvent::Kind::kExceptionBegins:
        levels_.push_back({event.at, event.sp, event.sp});
        break;
      case CallEvent::Kind::kExceptionEnds: {
        if (levels_.empty()) break;
        const Level level = levels_.back();
        levels_.pop_back();
        InterruptCost& cost = profile_.interrupts_[event.which];
        ++cost.count;
        cost.longest = std::max(cost.longest, event.at - level.begun);
        cost.stack_bytes = std::max(cost.stack_bytes, level.sp - level.lowest_sp);
        if (!levels_.empty()) levels_.back().lowest_sp = std::min(levels_.back().lowest_sp, level.lowest_sp);
        break;
      }
    }
  }

  ImageProfile& profile_;
  mcu::Machine& machine_;
  std::vector<int> open_;
  std::vector<Level> levels_;
  std::uint32_t begin_ = 0, bytes_ = 0;
  std::uint64_t* counts_ = nullptr;
};

ImageProfile::ImageProfile() = default;
ImageProfile::~ImageProfile() = default;

void ImageProfile::begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t) {
  image_functions_.insert(image.functions.begin(), image.functions.end());
  for (const mcu::ElfSegment& segment : image.segments) {
    auto& counts = counts_[segment.address];
    counts.resize(std::max(counts.size(), segment.bytes.size() / 2 + 1));
  }
  for (int b = 0; b < firmware.boards(); ++b)
    boards_.emplace_back(&firmware, std::make_unique<Board>(*this, firmware.board(b).machine(), image));
}

void ImageProfile::ends(mcu::McuFirmware& firmware) {
  for (auto& [of, board] : boards_) {
    if (of == &firmware) board->end();
  }
  std::erase_if(boards_, [&](const auto& entry) { return entry.first == &firmware; });
}

std::uint64_t ImageProfile::runs_of(std::uint32_t address) const {
  auto after = counts_.upper_bound(address);
  if (after == counts_.begin()) return 0;
  --after;
  const std::size_t at = (address - after->first) / 2;
  return at < after->second.size() ? after->second[at] : 0;
}

}  // namespace omnihil
