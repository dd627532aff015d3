#include "hil/observe/wave_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "hil/observe/bus_waves.h"
#include "hil/observe/encoder_waves.h"
#include "hil/observe/exception_names.h"
#include "hil/observe/pin_waves.h"
#include "hil/observe/pwm_waves.h"
#include "hil/observe/vcd_text.h"

namespace omnihil {

class WaveTrace::Board final : public mcu::MachineObserver {
 public:
  Board(mcu::McuFirmware& firmware, mcu::McuBoard& board, WaveLog& log, std::string scope)
      : firmware_(&firmware),
        machine_(&board.machine()),
        log_(log),
        scope_(std::move(scope)),
        pwm_(board, log, scope_),
        encoders_(board, log, scope_) {
    watch_pins(board, log, scope_);
    watch_buses(board, log, scope_);
    machine_->observe(this, false);
  }

  bool is_of(const mcu::McuFirmware& firmware) const { return firmware_ == &firmware; }
  bool over() const { return machine_ == nullptr; }
  void end() {
    const std::int64_t at_ns = machine_->to_ns(machine_->now());
    machine_->observe(nullptr);
    machine_ = nullptr;
    firmware_ = nullptr;
    pwm_.finish();
    encoders_.finish(at_ns);
    log_.reaches(at_ns);
  }

  void exception_begins(int exception, mcu::Cycles at) override { put(exception, at, 1); }
  void exception_ends(int exception, mcu::Cycles at) override { put(exception, at, 0); }
  void was_reset(mcu::Cycles at) override {
    for (const auto& [exception, signal] : exceptions_) put(exception, at, 0);
  }

 private:
  void put(int exception, mcu::Cycles at, std::uint64_t level) {
    const auto [known, is_new] = exceptions_.try_emplace(exception, -1);
    if (is_new) {
      std::string name = exception_name(exception);
      std::erase(name, ' ');
      known->second = log_.add(scope_, name, WaveKind::kLevel, 1, {0, false});
    }
    log_.put(known->second, machine_->to_ns(at), level);
  }

  mcu::McuFirmware* firmware_;
  mcu::Machine* machine_;  // null: its run is over
  WaveLog& log_;
  std::string scope_;
  PwmWaves pwm_;
  EncoderWaves encoders_;
  std::map<int, int> exceptions_;  // their signals
};

WaveTrace::WaveTrace(TraceOptions options) : log_(std::move(options)) {}
WaveTrace::~WaveTrace() = default;

void WaveTrace::begins(mcu::McuFirmware& firmware, const mcu::ElfImage&, std::uint32_t robot_id) {
  for (int b = 0; b < firmware.boards(); ++b) {
    const std::string robot = fmt::format("robot{}", robot_id);
    boards_.push_back(
        std::make_unique<Board>(firmware, firmware.board(b), log_,
                                firmware.boards() == 1 ? robot : fmt::format("{}.board{}", robot, b)));
  }
}

void WaveTrace::ends(mcu::McuFirmware& firmware) {
  for (const auto& board : boards_)
    if (board->is_of(firmware)) board->end();
}

std::string WaveTrace::text() const { return vcd_text(log_); }

void WaveTrace::clear() {
  std::erase_if(boards_, [](const auto& board) { return board->over(); });
  if (boards_.empty()) log_.clear();
}

}  // namespace omnihil
