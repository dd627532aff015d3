// GDB attached to the emulated boards of a bench: one thread per board, one wire, everything stands while one stands.
//
//   GdbServer server(std::move(wire), {.robot = 3});
//   server.add({.robot = 3, .board = 0, .machine = &machine, .image = &image});      // every board, before it runs
//   …                                              // the bench runs; it waits within a board's run while GDB says so
//   clock.forgive(server.take_stood_ns());
//   server.end(0);                                 // GDB is told that the program has ended
//
// The bench has one thread and no time of its own beside the boards', so a board that halts holds the clock, the plant,
// the other robots and the host's answers as well. Boards run by turns, each for a coupling period: those after the one
// that halted are up to that much behind it. Without a client nothing is halted. A client that leaves takes its
// breakpoints with it and the bench goes on; the next one may come.
// Law: GDB manual, appendix "Remote Protocol", all-stop. Breakpoints of both kinds (Z0, Z1) are hardware's: nothing of the
// image is changed. Back in time, within the last runs of the board that halted, GDB looks and changes nothing (gdb_past.cc).
// Cannot: flashing, tracepoints; boards whose cores have other registers at once.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/machine/machine.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "hil/debugger/gdb_moments.h"
#include "hil/debugger/gdb_packet.h"
#include "hil/debugger/gdb_target.h"
#include "hil/wire/buffered_wire.h"

namespace omnihil {

struct DebuggedBoard {
  int robot = 0, board = 0;
  mcu::Machine* machine = nullptr;
  const mcu::ElfImage* image = nullptr;
  const mcu::Chip* chip = nullptr;  // null: its registers have no names
  bool alone = true;                // of its robot
};

struct GdbServerOptions {
  int robot = -1, board = -1;  // only these; -1: all
  bool wait = true;            // before the first instruction, until GDB says to go on
  std::function<bool()> asked_to_end = [] { return false; };
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

class GdbServer final : public mcu::DebugListener {
 public:
  GdbServer(std::unique_ptr<ByteWire> wire, GdbServerOptions options);
  ~GdbServer() override;

  void add(const DebuggedBoard& board);
  // Why what was added cannot be debugged together; empty: it can.
  std::string problem() const;
  std::string_view name() const { return wire_.name(); }
  // Of wall time that the bench has stood since the last call, for a clock to forgive.
  std::int64_t take_stood_ns() { return std::exchange(stood_ns_, 0); }
  // The bench is over: nothing halts any more, and GDB hears the exit code.
  void end(int exit_code);

 private:
  struct Board {
    DebuggedBoard is;
    mcu::DebugUnit* unit = nullptr;
    std::string name() const;
  };
  enum class Then : std::uint8_t { kStay, kGoOn };

  // DebugListener
  void about_to_run(mcu::DebugUnit& unit) override;
  void halted(mcu::DebugUnit& unit, const mcu::Halt& halt) override;

  void listen();
  void hold();
  void attach();
  void detach();
  void send(std::string_view data);
  Then take_events();
  Then command(std::string_view packet);
  Then resume(std::string_view actions);
  void apply();
  std::string stop_reply(std::string_view history = "") const;
  std::string query(std::string_view packet);
  std::string transfer(std::string_view packet) const;
  std::string threads_xml() const;
  std::string read_memory(std::string_view packet);
  std::string write_memory(std::string_view packet, bool binary);
  std::string read_register(std::string_view packet);
  std::string write_register(std::string_view packet);
  std::string all_registers();
  std::string write_all_registers(std::string_view digits);
  std::string change_point(std::string_view packet, bool insert);
  std::string choose_thread(std::string_view packet);
  void monitor(const std::string& words);
  std::size_t thread_of(std::string_view text) const;  // a board's place, or boards_.size()
  // gdb_past.cc
  struct PastRun;
  struct KeepPast {
    void operator()(PastRun* run) const;
  };
  GdbTalk talk() const;
  void take_talk(const GdbTalk& talk);
  void keep_moment(mcu::DebugUnit& unit);
  Then go_back(char how);  // 's' an instruction, 'c' to the last halt
  Then lose_past();
  [[noreturn]] void be_past(mcu::DebugUnit& unit, PastOrder order);
  [[noreturn]] void leave_past(char what);
  void past_halted(const mcu::Halt& halt);
  void stand_in_past(const std::string& reply);
  void changed() { moments_.forget(); }  // what was before does not lead here any more
  void go_on_in_past(char how);

  mcu::Machine& chosen() { return *boards_[chosen_].is.machine; }

  BufferedWire wire_;
  GdbServerOptions options_;
  GdbInput input_;
  std::vector<Board> boards_;
  std::vector<GdbRegister> registers_;
  std::vector<std::uint32_t> breakpoints_;
  std::vector<mcu::AccessWatch> watches_;
  std::size_t stopped_ = 0, chosen_ = 0;  // which board halted; which one GDB asks about
  mcu::Halt halt_;
  bool attached_ = false, waiting_for_first_ = false, acks_ = true, owes_stop_ = false, ended_ = false,
       left_ = false;
  std::int64_t stood_ns_ = 0;
  GdbMoments moments_;
  bool keeps_past_ = true, stepped_ = false;  // GDB's last wish was a step
  std::unique_ptr<PastRun, KeepPast> past_;   // in a copy that shows the past; null: this is the present
};

// What `monitor` says and does with a board; GDB prints it.
std::string gdb_monitor(std::string_view words, const DebuggedBoard& board, bool& reset);

}  // namespace omnihil
