#include "firmware_iface/mcu/rp2040/ssi.h"

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t { kSr = 0x28, kTxLevel = 0x20, kRxLevel = 0x24, kDr0 = 0x60, kSelectCtrl = 0x0C };
constexpr RegisterInfo kSsi[] = {{0x00, "CTRLR0"},
                                 {0x04, "CTRLR1"},
                                 {0x08, "SSIENR"},
                                 {0x0C, "MWCR"},
                                 {0x10, "SER"},
                                 {0x14, "BAUDR"},
                                 {0x18, "TXFTLR"},
                                 {0x1C, "RXFTLR"},
                                 {0x20, "TXFLR", 0, 0},
                                 {0x24, "RXFLR", 0, 0},
                                 {kSr, "SR", 0, 0},
                                 {0x2C, "IMR", 0, 0x3F, 0x3F},
                                 {0x30, "ISR", 0, 0},
                                 {0x34, "RISR", 0, 0},
                                 {0x48, "ICR", 0, 0},
                                 {0x4C, "DMACR", 0, 3, 3},
                                 {0x58, "IDR", 0x51535049, 0},
                                 {0x5C, "SSI_VERSION_ID", 0x3430312A, 0},
                                 {kDr0, "DR0", 0, 0},
                                 {0xF0, "RX_SAMPLE_DLY"},
                                 {0xF4, "SPI_CTRLR0", 0x03000000},
                                 {0xF8, "TXD_DRIVE_EDGE"}};
constexpr RegisterInfo kXip[] = {{0x00, "CTRL", 3, 0x0B, 0x08},
                                 {0x04, "FLUSH", 0, 1},
                                 {0x08, "STAT", 2, 0},
                                 {0x0C, "CTR_HIT"},
                                 {0x10, "CTR_ACC"},
                                 {0x14, "STREAM_ADDR", 0, 0xFFFFFFFC},
                                 {0x18, "STREAM_CTR", 0, 0x003FFFFF, 0x003FFFFF},
                                 {0x1C, "STREAM_FIFO", 0, 0}};
constexpr RegisterInfo kQspi[] = {{0x00, "GPIO_QSPI_SCLK_STATUS", 0, 0},
                                  {0x04, "GPIO_QSPI_SCLK_CTRL", 0x1F, 0x3003331F},
                                  {0x08, "GPIO_QSPI_SS_STATUS", 0, 0},
                                  {kSelectCtrl, "GPIO_QSPI_SS_CTRL", 0x1F, 0x3003331F},
                                  {0x10, "GPIO_QSPI_SD0_STATUS", 0, 0},
                                  {0x14, "GPIO_QSPI_SD0_CTRL", 0x1F, 0x3003331F},
                                  {0x18, "GPIO_QSPI_SD1_STATUS", 0, 0},
                                  {0x1C, "GPIO_QSPI_SD1_CTRL", 0x1F, 0x3003331F},
                                  {0x20, "GPIO_QSPI_SD2_STATUS", 0, 0},
                                  {0x24, "GPIO_QSPI_SD2_CTRL", 0x1F, 0x3003331F},
                                  {0x28, "GPIO_QSPI_SD3_STATUS", 0, 0},
                                  {0x2C, "GPIO_QSPI_SD3_CTRL", 0x1F, 0x3003331F},
                                  {0x30, "INTR", 0, 0},
                                  {0x34, "PROC0_INTE", 0, 0x00FFFFFF, 0x00FFFFFF},
                                  {0x38, "PROC0_INTF", 0, 0x00FFFFFF, 0x00FFFFFF},
                                  {0x3C, "PROC0_INTS", 0, 0}};
constexpr std::uint32_t kOverride = 3u << 8, kForcedLow = 2u << 8;
}  // namespace

IoQspi::IoQspi(std::shared_ptr<FlashChip> flash, ChipContext& context)
    : Rp2040Block("IO_QSPI", context.system, kQspi), flash_(std::move(flash)) {
  next_event_is(kNever);
}
bool IoQspi::forces_select() const { return (value(kSelectCtrl) & kOverride) >= kForcedLow; }
void IoQspi::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset == kSelectCtrl) flash_->select((value(kSelectCtrl) & kOverride) == kForcedLow);
}

Ssi::Ssi(std::shared_ptr<FlashChip> flash, const IoQspi& pins, ChipContext& context)
    : RegisterBlock("SSI", context.system, kSsi), flash_(std::move(flash)), pins_(pins) {
  next_event_is(kNever);
}

void Ssi::reset() {
  RegisterBlock::reset();
  received_.clear();
}

std::uint32_t Ssi::load(std::uint32_t offset) {
  const std::uint32_t is = shown(offset);
  if (offset == kSr && !pins_.forces_select()) flash_->select(false);
  if (offset == kDr0 && !received_.empty()) received_.pop_front();
  return is;
}

std::uint32_t Ssi::shown(std::uint32_t offset) {
  if (offset == kSr) return 1u << 2 | 1u << 1 | (received_.empty() ? 0u : 1u << 3);  // TFE, TFNF, RFNE
  if (offset == kRxLevel) return static_cast<std::uint32_t>(received_.size());
  if (offset == kDr0) return received_.empty() ? 0u : received_.front();
  return value(offset);
}

void Ssi::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset != kDr0) {
    keep(offset, written, lanes);
    if (offset == 0x08 && (written & 1u) == 0) received_.clear();
    return;
  }
  constexpr std::size_t kFifo = 16;
  if (!pins_.forces_select() && !flash_->selected()) flash_->select(true);
  const std::uint8_t in = flash_->exchange(static_cast<std::uint8_t>(written));
  if (received_.size() < kFifo) received_.push_back(in);
}

XipControl::XipControl(ChipContext& context) : RegisterBlock("XIP_CTRL", context.system, kXip) {
  next_event_is(kNever);
}
std::uint32_t XipControl::load(std::uint32_t offset) {
  if (offset == 0x04) return 0;                // FLUSH: done at once
  return offset == 0x08 ? 3u : value(offset);  // stream FIFO empty, flush ready
}

}  // namespace omnihil::mcu::rp2040
