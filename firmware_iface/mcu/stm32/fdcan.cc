#include "firmware_iface/mcu/stm32/fdcan.h"

#include <algorithm>
#include <cmath>

namespace omnihil::mcu {

std::uint32_t FdcanRam::read(std::uint32_t offset, unsigned bytes) {
  std::uint32_t v = 0;
  for (unsigned i = 0; i < bytes && offset + i < bytes_.size(); ++i)
    v |= std::uint32_t{bytes_[offset + i]} << (8 * i);
  return v;
}

void FdcanRam::write(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  for (unsigned i = 0; i < bytes && offset + i < bytes_.size(); ++i)
    bytes_[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

Fdcan::Fdcan(int number, std::span<const RegisterInfo> registers, const FdcanMap& map, Bus kernel,
             std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context)
    : RegisterBlock("FDCAN" + std::to_string(number), context.system, registers),
      ram_(ram),
      map_(map),
      kernel_(kernel),
      context_(context),
      irq0_(context.irqs, irqs.first),
      irq1_(context.irqs, irqs.second) {
  next_event_is(sent_at_);
}

void Fdcan::reset() {
  RegisterBlock::reset();
  fifos_ = {};
  asked_.clear();
  sent_at_ = kNever;
  update();
}

CanFrame Fdcan::buffer(unsigned place) const {
  const std::uint32_t at = transmit_element(place);
  const unsigned room = transmit_room();
  const std::uint32_t t0 = ram_.word(at), t1 = ram_.word(at + 4);
  CanFrame frame;
  frame.extended = bit(t0, 30);
  frame.remote = bit(t0, 29);
  frame.id = frame.extended ? t0 & 0x1FFFFFFFu : field(t0, 18, 11);
  frame.fd = bit(t1, 21) && bit(value(kCccr), 8);
  frame.fast = frame.fd && bit(t1, 20) && bit(value(kCccr), 9);
  frame.bytes = static_cast<std::uint8_t>(can_bytes(field(t1, 16, 4), frame.fd));
  for (unsigned i = 0; i < frame.bytes; ++i)  // beyond the element's room: 0xCC (RM0433 56.3.5)
    frame.data[i] = i < room ? static_cast<std::uint8_t>(ram_.read(at + 8 + i, 1)) : 0xCC;
  return frame;
}

double Fdcan::bit_clocks() const {
  const std::uint32_t n = value(kNbtp);
  return (field(n, 16, 9) + 1.0) * (3.0 + field(n, 8, 8) + field(n, 0, 7));
}

double Fdcan::core_cycles(double clocks) const {
  return clocks * divider() * system().core_hz() / context_.clocks.bus_hz(kernel_);
}

void Fdcan::transmit_next() {
  if (sent_at_ != kNever || asked_.empty() || !running()) return;
  // Dedicated buffers and a queue by identifier; a FIFO's elements among themselves in order. The lowest goes first.
  const bool queue = bit(value(kTxbc), map_.queue);
  const auto key = [this](unsigned b) {
    const CanFrame f = buffer(b);
    return f.extended ? std::uint64_t{f.id} << 1 | 1 : std::uint64_t{f.id} << 19;
  };
  auto best = asked_.end();
  bool fifo_seen = false;
  for (auto at = asked_.begin(); at != asked_.end(); ++at) {
    const bool in_fifo = !queue && *at >= dedicated();
    if (in_fifo && fifo_seen) continue;
    fifo_seen = fifo_seen || in_fifo;
    if (best == asked_.end() || key(*at) < key(*best)) best = at;
  }
  std::rotate(asked_.begin(), best, best + 1);
  const CanFrame frame = buffer(asked_.front());
  const std::uint32_t d = value(kDbtp);
  const double fast = core_cycles((field(d, 16, 5) + 1.0) * (3.0 + field(d, 8, 5) + field(d, 4, 4)));
  const double cycles = can_frame_bits(frame) * bit_cycles() + can_fast_bits(frame) * fast;
  sent_at_ = now() + std::max<Cycles>(1, static_cast<Cycles>(std::llround(cycles)));
}

void Fdcan::run_events() {
  if (sent_at_ > now() || asked_.empty()) return;
  const unsigned place = asked_.front();
  const Cycles end = sent_at_;
  const CanFrame frame = buffer(place);
  asked_.erase(asked_.begin());
  sent_at_ = kNever;
  value(map_.txbrp) &= ~(1u << place);
  value(map_.txbto) |= 1u << place;
  if (bit(value(map_.txbtie), place)) value(kIr) |= map_.sent;
  const bool queued =
      std::any_of(asked_.begin(), asked_.end(), [this](unsigned b) { return b >= dedicated(); });
  if (place >= dedicated() && !queued) value(kIr) |= map_.empty;
  transmitted(place);
  transmit_next();
  const bool loop = bit(value(kCccr), 7) && bit(value(kTest), 4), silent = loop && bit(value(kCccr), 5);
  if (loop) take(frame);
  if (!silent) sent(frame, end);
  update();
}

Fdcan::Filter Fdcan::filter(bool extended, std::uint32_t list, unsigned index) const {
  if (extended) {
    const std::uint32_t f0 = ram_.word(list + 8 * index), f1 = ram_.word(list + 8 * index + 4);
    return {f0 & 0x1FFFFFFFu, f1 & 0x1FFFFFFFu, f0 >> 29, f1 >> 30};
  }
  const std::uint32_t f = ram_.word(list + 4 * index);
  const unsigned kind = f >> 30;  // 3: switched off
  return {field(f, 16, 11), field(f, 0, 11), kind == 3 ? 0 : field(f, 27, 3), kind};
}

// The first filter that matches decides.
Fdcan::Verdict Fdcan::judge(const CanFrame& frame) const {
  const std::uint32_t global = value(map_.filtering);
  if (frame.remote && bit(global, frame.extended ? 0 : 1)) return {};
  const Filters list = filters(frame.extended);
  const std::uint32_t masked = frame.extended ? frame.id & value(map_.xidam) : frame.id;
  for (unsigned i = 0; i < list.count; ++i) {
    const Filter by = filter(frame.extended, list.at, i);
    if (by.action == 0 || (by.action == 7 && !map_.to_buffers)) continue;
    const std::uint32_t id = by.kind == 3 ? frame.id : masked;  // a range without the extended mask
    // action 7: into a buffer, no other kind there
    if (!(by.action == 7 ? id == by.id1 : by.takes(id))) continue;
    Verdict verdict{.index = i, .matched = true};  // rejected, or its priority alone is said, but for
    if (by.action == 7) verdict.buffer = static_cast<int>(by.id2 & 63u);
    if (by.action == 1 || by.action == 5) verdict.fifo = 0;
    if (by.action == 2 || by.action == 6) verdict.fifo = 1;
    return verdict;
  }
  const unsigned rest = field(global, frame.extended ? 2 : 4, 2);
  return {.fifo = rest < 2 ? static_cast<int>(rest) : -1};
}

void Fdcan::take(const CanFrame& frame) {
  if (!running() || (frame.fd && !bit(value(kCccr), 8))) return off_bus(now());
  const Verdict verdict = judge(frame);
  if (verdict.buffer >= 0) {
    put_in_buffer(frame, verdict);
    update();
    return system().reschedule();
  }
  if (verdict.fifo < 0) return unwanted(now());
  put_in_fifo(frame, verdict);
}

void Fdcan::write_element(std::uint32_t at, const CanFrame& frame, const Verdict& verdict, unsigned room) {
  ram_.write(at, 4, (frame.extended ? 1u << 30 | frame.id : frame.id << 18) | (frame.remote ? 1u << 29 : 0u));
  ram_.write(at + 4, 4,
             (verdict.matched ? 0u : 1u << 31) | verdict.index << 24 | (frame.fd ? 1u << 21 : 0u) |
                 (frame.fast ? 1u << 20 : 0u) | can_dlc(frame.bytes) << 16);
  for (unsigned i = 0; i < frame.bytes && i < room; ++i) ram_.write(at + 8 + i, 1, frame.data[i]);
}

void Fdcan::put_in_fifo(const CanFrame& frame, const Verdict& verdict) {
  const auto which = static_cast<unsigned>(verdict.fifo), shift = map_.fifo_shift * which;
  const Place place = fifo(which);
  if (place.places == 0) return unwanted(now());
  Fifo& its = fifos_[which];
  if (its.fill >= place.places) {
    its.lost = true;
    overflow(now());
    value(kIr) |= map_.fifo_lost << shift;
    if (!place.overwrites) return update();  // blocking; else the oldest goes
    its.get = (its.get + 1) % place.places;
    --its.fill;
  }
  write_element(place.at + (8 + place.room) * ((its.get + its.fill) % place.places), frame, verdict,
                place.room);
  ++its.fill;
  value(kIr) |=
      (map_.fifo_new | (place.watermark != 0 && its.fill == place.watermark ? map_.fifo_watermark : 0u) |
       (its.fill == place.places ? map_.fifo_full : 0u))
      << shift;
  update();
  system().reschedule();
}

std::uint32_t Fdcan::status(const Fifo& fifo, unsigned places) {
  const unsigned put = places == 0 ? 0 : (fifo.get + fifo.fill) % places;
  return fifo.fill | fifo.get << 8 | put << 16 | (places != 0 && fifo.fill == places ? 1u << 24 : 0u) |
         (fifo.lost ? 1u << 25 : 0u);
}

// Elements up to this one have been read.
void Fdcan::acknowledge(Fifo& fifo, unsigned up_to, unsigned places) {
  if (places == 0) return;
  const unsigned count = (up_to % places + 1 + places - fifo.get) % places;
  const unsigned taken = std::min(fifo.fill, count == 0 ? places : count);
  fifo.get = (fifo.get + taken) % places;
  fifo.fill -= taken;
  fifo.lost = false;
}

std::uint32_t Fdcan::request(std::uint32_t wanted, unsigned places) {
  if (!running()) return 0;
  std::uint32_t asked = 0;
  for (unsigned b = 0; b < places; ++b) {
    if (!bit(wanted, b) || bit(value(map_.txbrp), b)) continue;
    value(map_.txbrp) |= 1u << b;
    value(map_.txbto) &= ~(1u << b);
    value(map_.txbcf) &= ~(1u << b);
    asked_.push_back(b);
    asked |= 1u << b;
  }
  transmit_next();
  return asked;
}

void Fdcan::cancel(std::uint32_t wanted) {
  for (unsigned b = 0; b < 32; ++b) {
    const auto at = std::find(asked_.begin(), asked_.end(), b);
    if (!bit(wanted, b) || at == asked_.end() || (at == asked_.begin() && sent_at_ != kNever)) continue;
    asked_.erase(at);
    value(map_.txbrp) &= ~(1u << b);
    value(map_.txbcf) |= 1u << b;
    if (bit(value(map_.txbcie), b)) value(kIr) |= map_.cancelled;
  }
}

void Fdcan::update() {
  const std::uint32_t active = value(kIr) & value(kIe), second = second_line();
  irq0_.set(bit(value(kIle), 0) && (active & ~second) != 0);
  irq1_.set(bit(value(kIle), 1) && (active & second) != 0);
}

// CCCR, IR and what is merely kept.
void Fdcan::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kIr) {
    value(kIr) &= ~written;
  } else {
    keep(offset, written, lanes);
  }
  if (offset == kCccr) {
    std::uint32_t& cccr = value(kCccr);
    if (running()) {
      cccr &= ~2u;  // CCE only with INIT
      context_.clocks.need(kernel_, name());
    }
    cccr = (cccr & ~8u) | (cccr & 0x10u) >> 1;  // CSA follows CSR
    transmit_next();
  }
  update();
}

}  // namespace omnihil::mcu
