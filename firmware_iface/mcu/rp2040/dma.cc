#include "firmware_iface/mcu/rp2040/dma.h"

#include <algorithm>
#include <utility>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t {
  kIntr = 0x400,
  kInte0 = 0x404,
  kIntf0 = 0x408,
  kInts0 = 0x40C,
  kInte1 = 0x414,
  kIntf1 = 0x418,
  kInts1 = 0x41C,
  kTimer0 = 0x420,
  kMulti = 0x430,
  kSniffControl = 0x434,
  kAbort = 0x444
};
constexpr unsigned kFirstTimer = 0x3B, kAlways = 0x3F, kEnable = 0, kIrqQuiet = 21, kByteSwap = 22;
constexpr std::uint32_t kBusy = 1u << 24, kWritable = 0x00FFFFFF, kAll = 0xFFF;
// Registers of a channel in the order of each of its four views; the last one of a view triggers.
enum Field : unsigned { kRead, kWrite, kCount, kCtrl };
constexpr Field kViews[4][4] = {{kRead, kWrite, kCount, kCtrl},
                                {kCtrl, kRead, kWrite, kCount},
                                {kCtrl, kCount, kRead, kWrite},
                                {kCtrl, kWrite, kCount, kRead}};

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    constexpr const char* kFields[] = {"READ_ADDR", "WRITE_ADDR", "TRANS_COUNT", "CTRL"};
    for (std::uint32_t c = 0; c < 12; ++c) {
      for (std::uint32_t view = 0; view < 4; ++view) {
        for (std::uint32_t i = 0; i < 4; ++i) {
          const Field which = kViews[view][i];
          const std::string name = "CH" + std::to_string(c) +
                                   (view == 0 ? "_" : "_AL" + std::to_string(view) + "_") + kFields[which] +
                                   (i == 3 ? "_TRIG" : "");
          t.add(0x40 * c + 0x10 * view + 4 * i, name, 0, 0xFFFFFFFF, which == kCtrl ? 0x00800000u : 0u);
        }
      }
    }
    t.add(kIntr, "INTR", 0, 0);
    t.add(kInte0, "INTE0", 0, kAll);
    t.add(kIntf0, "INTF0", 0, kAll);
    t.add(kInts0, "INTS0", 0, 0);
    t.add(kInte1, "INTE1", 0, kAll);
    t.add(kIntf1, "INTF1", 0, kAll);
    t.add(kInts1, "INTS1", 0, 0);
    for (std::uint32_t i = 0; i < 4; ++i) t.add(kTimer0 + 4 * i, "TIMER" + std::to_string(i));
    t.add(kMulti, "MULTI_CHAN_TRIGGER", 0, 0);
    t.add(kSniffControl, "SNIFF_CTRL", 0, 0xFFF, 1);
    t.add(0x438, "SNIFF_DATA");
    t.add(0x440, "FIFO_LEVELS", 0, 0);
    t.add(kAbort, "CHAN_ABORT", 0, 0);
    t.add(0x448, "N_CHANNELS", 12, 0);
    return t;
  }();
  return rows;
}
}  // namespace

std::vector<std::string> dma_requests() {
  std::vector<std::string> names;
  for (const char* pio : {"PIO0", "PIO1"}) {
    for (const char* way : {"_TX", "_RX"}) {
      for (unsigned i = 0; i < 4; ++i) names.push_back(pio + std::string(way) + std::to_string(i));
    }
  }
  for (const char* name :
       {"SPI0_TX", "SPI0_RX", "SPI1_TX", "SPI1_RX", "UART0_TX", "UART0_RX", "UART1_TX", "UART1_RX"})
    names.emplace_back(name);
  for (unsigned i = 0; i < 8; ++i) names.push_back("PWM_WRAP" + std::to_string(i));
  for (const char* name :
       {"I2C0_TX", "I2C0_RX", "I2C1_TX", "I2C1_RX", "ADC", "XIP_STREAM", "XIP_SSITX", "XIP_SSIRX"})
    names.emplace_back(name);
  return names;
}

Dma::Dma(const std::vector<std::string>& requests, ChipContext& context)
    : Rp2040Block("DMA", context.system, table().rows()),
      context_(context),
      first_(context.irqs, 11),
      second_(context.irqs, 12) {
  next_event_is(next_);
  for (const std::string& name : requests) lines_.push_back(context.dma.line(name));
  context.dma.add(*this);
}

void Dma::reset() {
  Rp2040Block::reset();
  channels_ = {};
  paced_.fill(kNever);
  rest_ = {};
  raw_ = to_trigger_ = 0;
  plan();
  update();
}

void Dma::trigger(unsigned number) {
  Channel& channel = channels_[number];
  if (!bit(channel.control, kEnable) || channel.busy) return;
  channel.left = channel.reload;
  channel.busy = true;
  const unsigned request = request_of(channel);
  if (request >= kFirstTimer && request < kAlways) {
    Cycles& next = paced_[request - kFirstTimer];
    if (next == kNever || next < now()) next = now();
  }
  if (on_wanted_) on_wanted_(request, true);
  if (channel.left == 0) return finish(number);
  serve(number);
}

// As long as what it waits for is there.
void Dma::serve(unsigned number) {
  Channel& channel = channels_[number];
  const unsigned request = request_of(channel);
  const bool outer = !std::exchange(draining_, true);  // what this one's items trigger waits for its end
  if (request == kAlways) {
    while (channel.busy && channel.left > 0) move(channel);
  } else if (request < lines_.size()) {
    while (channel.busy && channel.left > 0 && context_.dma.high(lines_[request])) {
      context_.dma.taken(lines_[request]);
      move(channel);
    }
  } else if (request < kFirstTimer) {
    system().report_unmodelled(name(), "TREQ_SEL " + std::to_string(request) + " is no request");
  }
  if (channel.busy && channel.left == 0) finish(number);
  if (!outer) return;
  draining_ = false;
  drain();
}

void Dma::move(Channel& channel) {
  const unsigned size = 1u << std::min(field(channel.control, 2, 2), 2u), ring = field(channel.control, 6, 4);
  std::uint32_t item = 0;
  if (context_.reaches(channel.read, name())) item = system().bus_read(channel.read, size);
  if (bit(channel.control, kByteSwap)) {
    item = size == 4 ? __builtin_bswap32(item) : size == 2 ? (item >> 8 & 0xFFu) | (item & 0xFFu) << 8 : item;
  }
  --channel.left;  // before the access: it may ask for the next item
  const std::uint32_t to = channel.write;
  const auto next = [&](std::uint32_t address, bool wraps) {
    const std::uint32_t mask = wraps && ring != 0 ? (1u << ring) - 1u : 0xFFFFFFFFu;
    return (address & ~mask) | ((address + size) & mask);
  };
  if (bit(channel.control, 4)) channel.read = next(channel.read, !bit(channel.control, 10));
  if (bit(channel.control, 5)) channel.write = next(channel.write, bit(channel.control, 10));
  if (context_.reaches(to, name())) system().bus_write(to, size, item);
}

void Dma::finish(unsigned number) {
  Channel& channel = channels_[number];
  channel.busy = false;
  if (on_wanted_) on_wanted_(request_of(channel), false);
  if (!bit(channel.control, kIrqQuiet)) raw_ |= 1u << number;
  const unsigned to = field(channel.control, 11, 4);
  if (to != number && to < kChannels) to_trigger_ |= 1u << to;
  drain();
  update();
}

// Chains one after the other, not within each other.
void Dma::drain() {
  if (draining_) return;
  draining_ = true;
  constexpr int kMost = 10'000;  // two channels without requests that start each other never end
  for (int rounds = 0; to_trigger_ != 0; ++rounds) {
    const auto number = static_cast<unsigned>(__builtin_ctz(to_trigger_));
    to_trigger_ &= to_trigger_ - 1;
    if (rounds > kMost) {
      system().report_unmodelled(name(),
                                 "channels that wait for nothing start each other without end: stopped");
      to_trigger_ = 0;
      break;
    }
    trigger(number);
  }
  draining_ = false;
}

void Dma::requested(int line) {
  for (unsigned i = 0; i < kChannels; ++i) {
    Channel& channel = channels_[i];
    const unsigned request = request_of(channel);
    if (channel.busy && request < lines_.size() && lines_[request] == line && bit(channel.control, kEnable))
      serve(i);
  }
}

// TIMERn: clk_sys X / Y.
void Dma::plan() {
  next_ = kNever;
  for (const Channel& channel : channels_) {
    const unsigned request = request_of(channel);
    if (channel.busy && request >= kFirstTimer && request < kAlways)
      next_ = std::min(next_, paced_[request - kFirstTimer]);
  }
}

void Dma::run_events() {
  if (next_ > now()) return;
  for (unsigned t = 0; t < kTimers; ++t) {
    if (paced_[t] <= now()) pace(t);
  }
  plan();
}

void Dma::pace(unsigned timer) {
  const std::uint32_t rate = value(kTimer0 + 4 * timer), x = rate >> 16, y = rate & 0xFFFFu;
  if (x == 0 || y == 0) {
    paced_[timer] = kNever;
    return;
  }
  const std::uint32_t parts = std::max(x, y) + rest_[timer];
  paced_[timer] = now() + parts / x;
  rest_[timer] = parts % x;
  draining_ = true;
  for (unsigned i = 0; i < kChannels; ++i) {
    Channel& channel = channels_[i];
    if (!channel.busy || request_of(channel) != kFirstTimer + timer || !bit(channel.control, kEnable))
      continue;
    move(channel);
    if (channel.left == 0) finish(i);
  }
  draining_ = false;
  drain();
}

void Dma::update() {
  first_.set(((raw_ & value(kInte0)) | value(kIntf0)) != 0);
  second_.set(((raw_ & value(kInte1)) | value(kIntf1)) != 0);
}

std::uint32_t Dma::load(std::uint32_t offset) {
  if (offset < 0x40 * kChannels) {
    const Channel& channel = channels_[offset / 0x40];
    switch (kViews[offset / 0x10 % 4][offset / 4 % 4]) {
      case kRead:
        return channel.read;
      case kWrite:
        return channel.write;
      case kCount:
        return channel.left;
      case kCtrl:
        return channel.control | (channel.busy ? kBusy : 0u);
    }
  }
  switch (offset) {
    case kIntr:
      return raw_;
    case kInts0:
      return (raw_ & value(kInte0)) | value(kIntf0);
    case kInts1:
      return (raw_ & value(kInte1)) | value(kIntf1);
    default:
      return value(offset);
  }
}

void Dma::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset < 0x40 * kChannels) {
    const unsigned number = offset / 0x40, place = offset / 4 % 4;
    Channel& channel = channels_[number];
    switch (kViews[offset / 0x10 % 4][place]) {
      case kRead:
        channel.read = written;
        break;
      case kWrite:
        channel.write = written;
        break;
      case kCount:
        channel.reload = written;
        break;
      case kCtrl:
        channel.control = written & kWritable;
        if (bit(written, kEnable) && channel.busy) serve(number);
        break;
    }
    if (place == 3) {
      if (written != 0) {
        to_trigger_ |= 1u << number;
        drain();
      } else if (bit(channel.control, kIrqQuiet)) {
        raw_ |= 1u << number;  // a null trigger
      }
    }
  } else if (offset == kMulti) {
    to_trigger_ |= written & kAll;
    drain();
  } else if (offset == kAbort) {
    for (unsigned i = 0; i < kChannels; ++i) {
      if (bit(written, i)) channels_[i].busy = false;
    }
  } else if (offset == kIntr || offset == kInts0 || offset == kInts1) {
    raw_ &= ~written;
  } else {
    keep(offset, written, lanes);
    if (offset >= kTimer0 && offset < kMulti && paced_[(offset - kTimer0) / 4] == kNever)
      paced_[(offset - kTimer0) / 4] = now() + 1;
  }
  plan();
  update();
}

}  // namespace omnihil::mcu::rp2040
