// FDCAN: frames in a message RAM, filters, two receive FIFOs, transmit FIFO or queue; what G4's (fdcan_g4.h) and H7's
// (fdcan_h7.h) have alike. Theirs is where things lie in the RAM, which filters there are and how registers are numbered.
//
//   FdcanRam ram;                                            // shared by all of a chip
//   std::unique_ptr<Fdcan> can = std::make_unique<FdcanG4>(1, std::pair{21, 22}, ram, context);
//
// Law: RM0440 §44, RM0433 §56 (Bosch M_CAN 3.2). Classic and FD frames; bit time (NBRP + 1)(3 + NTSEG1 + NTSEG2) of the kernel
// clock, data phase by DBTP. Cannot represent: what can.h says; time stamps, high-priority messages, restricted operation.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class FdcanRam final : public Peripheral {
 public:
  static constexpr std::uint32_t kBytes = 3 * 0x350;  // of G4: one part each
  explicit FdcanRam(std::uint32_t bytes = kBytes) : Peripheral("FDCAN message RAM"), bytes_(bytes, 0) {}
  void reset() override {}
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override;
  std::uint32_t peek(std::uint32_t offset) override { return read(offset, 4); }
  std::uint32_t word(std::uint32_t offset) { return read(offset, 4); }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Where a family has what the law speaks of: offsets of registers, bits of IR and TXBC.
struct FdcanMap {
  std::uint16_t filtering, xidam;  // GFC or RXGFC, whose bits 0 to 5 are alike; the extended mask
  bool to_buffers;                 // a filter's action 7, else it is reserved: the filter is switched off
  std::uint16_t txbrp, txbto, txbcf, txbtie, txbcie;
  std::uint32_t sent, cancelled, empty;  // IR: transmission completed, cancelled; transmit FIFO empty
  std::uint32_t fifo_new, fifo_watermark, fifo_full, fifo_lost;  // IR, of receive FIFO 0
  unsigned fifo_shift;                                           // from there to FIFO 1's
  unsigned queue;                                                // TXBC: a queue instead of a FIFO
};

class Fdcan : public RegisterBlock, public CanPort {
 public:
  void reset() override;
  void run_events() override;

 protected:
  enum : std::uint16_t {
    kDbtp = 0x0C,
    kTest = 0x10,
    kCccr = 0x18,
    kNbtp = 0x1C,
    kIr = 0x50,
    kIe = 0x54,
    kIls = 0x58,
    kIle = 0x5C,
    kTxbc = 0xC0,
    kTxfqs = 0xC4
  };
  static constexpr unsigned kMostRoom = 64;  // bytes of data in an element
  struct Fifo {
    unsigned get = 0, fill = 0;
    bool lost = false;
  };
  struct Place {  // of a FIFO in the RAM
    std::uint32_t at = 0;
    unsigned places = 0, room = kMostRoom, watermark = 0;
    bool overwrites = false;  // where it is full; else what comes is lost
  };
  struct Filters {  // a list in the RAM
    std::uint32_t at = 0;
    unsigned count = 0;
  };
  struct Filter {
    std::uint32_t id1 = 0, id2 = 0;
    unsigned action = 0, kind = 0;
    // By a range, two identifiers, or identifier and mask.
    bool takes(std::uint32_t id) const {
      return kind == 0 || kind == 3 ? id >= id1 && id <= id2
             : kind == 1            ? id == id1 || id == id2
                                    : ((id ^ id1) & id2) == 0;
    }
  };
  struct Verdict {
    int fifo = -1, buffer = -1;  // below 0: none
    unsigned index = 0;
    bool matched = false;
  };

  Fdcan(int number, std::span<const RegisterInfo> registers, const FdcanMap& map, Bus kernel,
        std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context);
  double bit_cycles() const override { return core_cycles(bit_clocks()); }
  Cycles present() const override { return now(); }
  void take(const CanFrame& frame) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

  virtual double divider() const { return 1.0; }  // of the kernel clock
  virtual Filters filters(bool extended) const = 0;
  virtual Place fifo(unsigned which) const = 0;
  virtual void put_in_buffer(const CanFrame& /*frame*/, const Verdict& /*verdict*/) {}
  virtual std::uint32_t second_line() const = 0;                     // flags of IR that ask by line 1
  virtual std::uint32_t transmit_element(unsigned place) const = 0;  // where it is in the RAM
  virtual unsigned transmit_room() const { return kMostRoom; }
  virtual unsigned dedicated() const { return 0; }  // buffers before the FIFO or queue
  virtual void transmitted(unsigned /*place*/) {}

  bool running() const { return (value(kCccr) & 1u) == 0; }
  CanFrame buffer(unsigned place) const;
  void write_element(std::uint32_t at, const CanFrame& frame, const Verdict& verdict, unsigned room);
  static std::uint32_t status(const Fifo& fifo, unsigned places);
  static void acknowledge(Fifo& fifo, unsigned up_to, unsigned places);
  std::uint32_t request(std::uint32_t wanted, unsigned places);  // those that did not wait yet
  void cancel(std::uint32_t wanted);
  void transmit_next();
  void update();

  FdcanRam& ram_;
  std::array<Fifo, 2> fifos_;
  std::vector<unsigned> asked_;  // buffers waiting, in the order of the requests

 private:
  Filter filter(bool extended, std::uint32_t list, unsigned index) const;
  Verdict judge(const CanFrame& frame) const;
  void put_in_fifo(const CanFrame& frame, const Verdict& verdict);
  double bit_clocks() const;  // of the nominal rate, behind the divider
  double core_cycles(double clocks) const;

  FdcanMap map_;
  Bus kernel_;
  ChipContext& context_;
  Cycles sent_at_ = kNever;
  IrqLine irq0_, irq1_;
};

// The registers that are alike, up to IR.
inline constexpr RegisterInfo kFdcanControl[] = {{0x00, "CREL", 0x32141218, 0},
                                                 {0x04, "ENDN", 0x87654321, 0},
                                                 {0x0C, "DBTP", 0x00000A33, 0x009F1FFF, 0x00800000},
                                                 {0x10, "TEST", 0, 0x70, 0x60},
                                                 {0x14, "RWD", 0, 0xFF, 0xFF},
                                                 {0x18, "CCCR", 1, 0xF3FF, 0xF064},
                                                 {0x1C, "NBTP", 0x06000A03, 0xFFFFFF7F},
                                                 {0x20, "TSCC", 0, 0xF0003, 0x3},
                                                 {0x24, "TSCV", 0, 0},
                                                 {0x28, "TOCC", 0xFFFF0000, 0xFFFF0007, 1},
                                                 {0x2C, "TOCV", 0xFFFF, 0},
                                                 {0x40, "ECR", 0, 0},
                                                 {0x44, "PSR", 0x707, 0},
                                                 {0x48, "TDCR", 0, 0x7F7F},
                                                 {0x50, "IR", 0, 0}};

}  // namespace omnihil::mcu
