// DMA of the RP2040: twelve channels, requests by number, chains, rings, its four timers, two interrupts.
//
//   Dma dma(requests, context);        // names of DmaRouter's lines by TREQ_SEL
//
// Law: RP2040 datasheet §2.5: a channel moves an item per request, or all at once without one; a trigger register set to
// zero is a null trigger; at the end it starts the channel that it is chained to. Items take no time of the bus: those
// without a request are there when the trigger's write ends. Cannot represent: priorities, bus errors, the sniffer, FIFO
// levels.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"
#include "firmware_iface/mcu/stm32/dma/dma_router.h"

namespace omnihil::mcu::rp2040 {

class Dma final : public Rp2040Block, public DmaSink {
 public:
  Dma(const std::vector<std::string>& requests, ChipContext& context);
  void reset() override;
  void run_events() override;
  void requested(int line) override;
  Cycles stable_until(std::uint32_t) const override { return kNever; }
  // Somebody waits for this request: for blocks that announce it only then.
  void on_wanted(std::function<void(unsigned request, bool wanted)> listener) {
    on_wanted_ = std::move(listener);
  }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  static constexpr unsigned kChannels = 12, kTimers = 4;
  struct Channel {
    std::uint32_t read = 0, write = 0, reload = 0, left = 0, control = 0;
    bool busy = false;
  };
  unsigned request_of(const Channel& channel) const { return field(channel.control, 15, 6); }
  void trigger(unsigned number);
  void serve(unsigned number);
  void move(Channel& channel);
  void finish(unsigned number);
  void drain();
  void pace(unsigned timer);
  void plan();
  void update();

  ChipContext& context_;
  std::vector<int> lines_;  // of DmaRouter, by request
  std::array<Channel, kChannels> channels_;
  std::array<Cycles, kTimers> paced_{};        // the next item of each timer
  std::array<std::uint32_t, kTimers> rest_{};  // of a cycle to it, in parts of X
  std::uint32_t raw_ = 0, to_trigger_ = 0;
  bool draining_ = false;
  IrqLine first_, second_;
  Cycles next_ = kNever;
  std::function<void(unsigned, bool)> on_wanted_;
};

// Names by TREQ_SEL (§2.5.3.1).
std::vector<std::string> dma_requests();

}  // namespace omnihil::mcu::rp2040
