// I2C0 and I2C1 of the RP2040 (datasheet §4.3, DW_apb_i2c): the master's commands by IC_DATA_CMD, FIFOs of 16, an abort
// where nobody answers, interrupts, DMA. A byte takes nine clocks, each high for HCNT + SPKLEN + 7 cycles and low for
// LCNT + 1 (§4.3.14; edges take no time). Not there: slave, 10-bit
// addresses, arbitration, stretching by devices.
#include <algorithm>
#include <deque>
#include <string>

#include "firmware_iface/mcu/rp2040/buses.h"

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint16_t {
  kCon = 0x00,
  kTar = 0x04,
  kData = 0x10,
  kSsHigh = 0x14,
  kSsLow = 0x18,
  kFsHigh = 0x1C,
  kFsLow = 0x20,
  kIntr = 0x2C,
  kMask = 0x30,
  kRaw = 0x34,
  kRxLevel = 0x38,
  kTxLevel = 0x3C,
  kClear = 0x40,
  kClearAbort = 0x54,
  kEnable = 0x6C,
  kStatus = 0x70,
  kTxCount = 0x74,
  kRxCount = 0x78,
  kAbortSource = 0x80,
  kDmaCr = 0x88,
  kDmaTx = 0x8C,
  kDmaRx = 0x90,
  kEnabled = 0x9C,
  kSpike = 0xA0
};
constexpr RegisterInfo kRegisters[] = {{kCon, "IC_CON", 0x65, 0x3FF, 0x18},
                                       {kTar, "IC_TAR", 0x55, 0xFFF, 0xC00},
                                       {0x08, "IC_SAR", 0x55, 0x3FF},
                                       {kData, "IC_DATA_CMD", 0, 0},
                                       {kSsHigh, "IC_SS_SCL_HCNT", 0x28, 0xFFFF},
                                       {kSsLow, "IC_SS_SCL_LCNT", 0x2F, 0xFFFF},
                                       {kFsHigh, "IC_FS_SCL_HCNT", 6, 0xFFFF},
                                       {kFsLow, "IC_FS_SCL_LCNT", 0xD, 0xFFFF},
                                       {kIntr, "IC_INTR_STAT", 0, 0},
                                       {kMask, "IC_INTR_MASK", 0x8FF, 0x1FFF},
                                       {kRaw, "IC_RAW_INTR_STAT", 0, 0},
                                       {kRxLevel, "IC_RX_TL", 0, 0xFF},
                                       {kTxLevel, "IC_TX_TL", 0, 0xFF},
                                       {kClear, "IC_CLR_INTR", 0, 0},
                                       {0x44, "IC_CLR_RX_UNDER", 0, 0},
                                       {0x48, "IC_CLR_RX_OVER", 0, 0},
                                       {0x4C, "IC_CLR_TX_OVER", 0, 0},
                                       {0x50, "IC_CLR_RD_REQ", 0, 0},
                                       {kClearAbort, "IC_CLR_TX_ABRT", 0, 0},
                                       {0x58, "IC_CLR_RX_DONE", 0, 0},
                                       {0x5C, "IC_CLR_ACTIVITY", 0, 0},
                                       {0x60, "IC_CLR_STOP_DET", 0, 0},
                                       {0x64, "IC_CLR_START_DET", 0, 0},
                                       {0x68, "IC_CLR_GEN_CALL", 0, 0},
                                       {kEnable, "IC_ENABLE", 0, 7, 4},
                                       {kStatus, "IC_STATUS", 6, 0},
                                       {kTxCount, "IC_TXFLR", 0, 0},
                                       {kRxCount, "IC_RXFLR", 0, 0},
                                       {0x7C, "IC_SDA_HOLD", 1, 0xFFFFFF},
                                       {kAbortSource, "IC_TX_ABRT_SOURCE", 0, 0},
                                       {0x84, "IC_SLV_DATA_NACK_ONLY", 0, 1, 1},
                                       {kDmaCr, "IC_DMA_CR", 0, 3},
                                       {kDmaTx, "IC_DMA_TDLR", 0, 15},
                                       {kDmaRx, "IC_DMA_RDLR", 0, 15},
                                       {0x94, "IC_SDA_SETUP", 0x64, 0xFF},
                                       {0x98, "IC_ACK_GENERAL_CALL", 1, 1},
                                       {kEnabled, "IC_ENABLE_STATUS", 0, 0},
                                       {kSpike, "IC_FS_SPKLEN", 7, 0xFF},
                                       {0xA8, "IC_CLR_RESTART_DET", 0, 0},
                                       {0xF4, "IC_COMP_PARAM_1", 0, 0},
                                       {0xF8, "IC_COMP_VERSION", 0x3230312A, 0},
                                       {0xFC, "IC_COMP_TYPE", 0x44570140, 0}};
constexpr std::size_t kDepth = 16;
// Raw interrupts.
constexpr std::uint32_t kRxUnder = 1, kRxOver = 2, kRxFull = 4, kTxOver = 8, kTxEmpty = 16, kTxAbort = 64,
                        kActivity = 256, kStop = 512, kStart = 1024;
// Of a command: read, stop behind it, start before it.
constexpr std::uint32_t kRead = 1u << 8, kThenStop = 1u << 9, kRestart = 1u << 10;
// What IC_CLR_… takes back, by their order from 0x44 on.
constexpr std::uint32_t kCleared[] = {kRxUnder, kRxOver,   kTxOver, 32,     kTxAbort,
                                      128,      kActivity, kStop,   kStart, 2048};
constexpr std::uint32_t kNoAddress = 1, kNoData = 8;  // causes of an abort

class I2cDw final : public Atomic<I2c> {
 public:
  I2cDw(const I2cSpec& spec, ChipContext& context) : Atomic<I2c>(spec, kRegisters, context) {
    next_event_is(at_);
  }
  void reset() override {
    RegisterBlock::reset();
    forget();
    latched_ = 0;
    update();
  }
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override {
    const std::uint32_t at = offset & 0xFFCu;
    return at == kData || (at >= kClear && at < kEnable) || at == 0xA8 ? 0 : kNever;
  }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  enum class Doing : std::uint8_t { kNothing, kAddress, kByte };
  void forget() {
    commands_.clear();
    received_.clear();
    device_ = nullptr;
    open_ = false;
    doing_ = Doing::kNothing;
    at_ = kNever;
    abort_source_ = 0;
  }
  void after_bits(unsigned bits) {
    const bool fast = field(value(kCon), 1, 2) != 1;
    const std::uint32_t high = value(fast ? kFsHigh : kSsHigh) + value(kSpike) + 7,
                        clock = high + value(fast ? kFsLow : kSsLow) + 1;
    at_ = now() + std::max<Cycles>(8, Cycles{bits} * clock);
  }
  void begin();
  void abort(std::uint32_t why);
  void stop();
  std::uint32_t raw() const;
  void update();

  std::deque<std::uint32_t> commands_;
  std::deque<std::uint8_t> received_;
  I2cDevice* device_ = nullptr;
  bool open_ = false, reading_ = false;  // between start and stop
  Doing doing_ = Doing::kNothing;
  std::uint32_t latched_ = 0, abort_source_ = 0;
  Cycles at_ = kNever;
};

void I2cDw::begin() {
  if (at_ != kNever || commands_.empty() || !bit(value(kEnable), 0) || abort_source_ != 0) return;
  const std::uint32_t command = commands_.front();
  const bool reads = (command & kRead) != 0;
  if (open_ && reads == reading_ && (command & kRestart) == 0) {
    doing_ = Doing::kByte;
    return after_bits(9);
  }
  reading_ = reads;
  open_ = true;
  latched_ |= kStart | kActivity;
  doing_ = Doing::kAddress;
  after_bits(10);  // start, seven bits, direction, acknowledge
}

void I2cDw::abort(std::uint32_t why) {
  latched_ |= kTxAbort;
  abort_source_ = why | static_cast<std::uint32_t>(commands_.size()) << 23;
  commands_.clear();
  stop();
}

void I2cDw::stop() {
  open_ = false;
  device_ = nullptr;
  latched_ |= kStop;
}

void I2cDw::run_events() {
  if (at_ > now()) return;
  at_ = kNever;
  if (doing_ == Doing::kAddress) {
    device_ = find(value(kTar) & 0x7Fu);
    if (device_ == nullptr) {
      abort(kNoAddress);
    } else {
      device_->start(reading_);
      doing_ = Doing::kByte;
      after_bits(9);
    }
  } else if (!commands_.empty()) {
    const std::uint32_t command = commands_.front();
    commands_.pop_front();
    bool taken = true;
    if (reading_) {
      const std::uint8_t byte = device_->read();
      if (received_.size() < kDepth)
        received_.push_back(byte);
      else
        latched_ |= kRxOver;
    } else {
      taken = device_->write(static_cast<std::uint8_t>(command));
    }
    if (!taken)
      abort(kNoData);
    else if ((command & kThenStop) != 0)
      stop();
    begin();
  }
  update();
}

std::uint32_t I2cDw::raw() const {
  return latched_ | (received_.size() > value(kRxLevel) ? kRxFull : 0u) |
         (bit(value(kEnable), 0) && commands_.size() <= value(kTxLevel) &&
                  (!bit(value(kCon), 8) || commands_.empty())
              ? kTxEmpty
              : 0u);
}

void I2cDw::update() {
  irq_event_.set((raw() & value(kMask)) != 0);
  context_.dma.set(dma_rx_, bit(value(kDmaCr), 0) && received_.size() > value(kDmaRx));
  context_.dma.set(dma_tx_,
                   bit(value(kDmaCr), 1) && bit(value(kEnable), 0) && commands_.size() <= value(kDmaTx));
}

std::uint32_t I2cDw::load(std::uint32_t offset) {
  const std::uint32_t is = shown(offset);
  if (offset == kData) {
    if (received_.empty())
      latched_ |= kRxUnder;
    else
      received_.pop_front();
  } else if (offset == kClear) {
    latched_ = 0;
    abort_source_ = 0;
  } else if ((offset > kClear && offset < kEnable) || offset == 0xA8) {
    latched_ &= ~(offset == 0xA8 ? 4096u : kCleared[(offset - kClear) / 4 - 1]);
    if (offset == kClearAbort) abort_source_ = 0;
  } else {
    return is;
  }
  begin();
  update();
  return is;
}

std::uint32_t I2cDw::shown(std::uint32_t offset) {
  switch (offset) {
    case kData:
      return received_.empty() ? 0u : received_.front();
    case kIntr:
      return raw() & value(kMask);
    case kRaw:
      return raw();
    case kStatus:
      return (open_ || at_ != kNever ? 0x21u : 0u) | (commands_.size() < kDepth ? 2u : 0u) |
             (commands_.empty() ? 4u : 0u) | (received_.empty() ? 0u : 8u) |
             (received_.size() >= kDepth ? 16u : 0u);
    case kTxCount:
      return static_cast<std::uint32_t>(commands_.size());
    case kRxCount:
      return static_cast<std::uint32_t>(received_.size());
    case kAbortSource:
      return abort_source_;
    case kEnabled:
      return value(kEnable) & 1u;
    default:
      return offset >= kClear && offset < kEnable ? 0u : value(offset);
  }
}

void I2cDw::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kData) {
    if (commands_.size() < kDepth)
      commands_.push_back(written & 0x7FFu);
    else
      latched_ |= kTxOver;
  } else {
    keep(offset, written, lanes);
    if (offset == kEnable && !bit(written, 0)) forget();
    if (offset == kEnable && bit(written, 1)) {  // ABORT
      abort(1u << 16);
      value(kEnable) &= ~2u;
    }
  }
  begin();
  update();
}
}  // namespace

std::unique_ptr<Atomic<I2c>> make_i2c_dw(unsigned number, int irq, ChipContext& context) {
  return std::make_unique<I2cDw>(I2cSpec{.name = "I2C" + std::to_string(number), .irq_event = irq}, context);
}

}  // namespace omnihil::mcu::rp2040
