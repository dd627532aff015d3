// What GDB asks of a bench that stands: registers, memory, breakpoints, threads.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "hil/debugger/gdb_server.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::size_t kPacketBytes = 0x4000;
constexpr std::string_view kOk = "OK", kBad = "E01", kNotThere = "E0e", kUnknown;

std::string hex_of(std::uint64_t value, unsigned bytes) {  // in the core's order
  std::string text;
  for (unsigned i = 0; i < bytes; ++i) text += fmt::format("{:02x}", value >> 8 * i & 0xFF);
  return text;
}

std::uint64_t value_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

// address,length at the begin of a packet's rest.
struct Place {
  std::uint32_t address = 0, bytes = 0;
};
std::optional<Place> take_place(std::string_view& text) {
  const auto address = take_hex(text);
  if (!address || !take_word(text, ",")) return std::nullopt;
  const auto bytes = take_hex(text);
  if (!bytes || *address > 0xFFFFFFFF || *bytes > kPacketBytes) return std::nullopt;
  return Place{static_cast<std::uint32_t>(*address), static_cast<std::uint32_t>(*bytes)};
}

// A part of a document, as qXfer asks for it: l before the last part, m before others.
std::string part_of(const std::string& document, std::string_view range) {
  const auto from = take_hex(range);
  if (!from || !take_word(range, ",")) return std::string(kBad);
  const auto most = take_hex(range);
  if (!most) return std::string(kBad);
  if (*from >= document.size()) return "l";
  const std::string part = document.substr(*from, *most);
  return (*from + part.size() < document.size() ? "m" : "l") + part;
}

}  // namespace

GdbServer::Then GdbServer::command(std::string_view packet) {
  if (acks_) wire_.write(std::vector<std::uint8_t>{'+'});
  std::string_view rest = packet;
  if (take_word(rest, "vCont?")) {
    send("vCont;c;C;s;S");
  } else if (take_word(rest, "vCont")) {
    return resume(rest);
  } else if (packet == "c" || packet == "s" || packet.starts_with("C") || packet.starts_with("S")) {
    const std::string step = fmt::format("s:{:x};c", stopped_ + 1);
    return resume((packet.front() | 0x20) == 's' ? std::string_view(step) : "c");
  } else if (packet == "bs" || packet == "bc") {
    const char how = packet == "bs" ? 's' : 'c';
    if (past_) leave_past(how);
    return go_back(how);
  } else if (take_word(rest, "D") || take_word(rest, "vKill") || packet == "k") {
    if (past_) leave_past('d');
    if (packet != "k") send(kOk);
    detach();
    return Then::kGoOn;
  } else if (packet == "QStartNoAckMode") {
    send(kOk);
    acks_ = false;
  } else if (take_word(rest, "qRcmd,")) {
    std::vector<std::uint8_t> words;
    parse_hex(rest, words);
    monitor({words.begin(), words.end()});
  } else if (packet == "?") {
    send(stop_reply());
  } else if (take_word(rest, "q")) {
    send(query(rest));
  } else if (packet == "g") {
    send(all_registers());
  } else if (take_word(rest, "G")) {
    send(write_all_registers(rest));
  } else if (take_word(rest, "p")) {
    send(read_register(rest));
  } else if (take_word(rest, "P")) {
    send(write_register(rest));
  } else if (take_word(rest, "m")) {
    send(read_memory(rest));
  } else if (take_word(rest, "M")) {
    send(write_memory(rest, false));
  } else if (take_word(rest, "X")) {
    send(write_memory(rest, true));
  } else if (take_word(rest, "Z")) {
    send(change_point(rest, true));
  } else if (take_word(rest, "z")) {
    send(change_point(rest, false));
  } else if (take_word(rest, "H")) {
    send(choose_thread(rest));
  } else if (take_word(rest, "T")) {
    send(thread_of(rest) < boards_.size() ? kOk : kBad);
  } else {
    send(kUnknown);
  }
  return Then::kStay;
}

std::size_t GdbServer::thread_of(std::string_view text) const {
  const auto id = take_hex(text);
  return id && *id >= 1 && *id <= boards_.size() ? static_cast<std::size_t>(*id - 1) : boards_.size();
}

// 0 and -1: any.
std::string GdbServer::choose_thread(std::string_view packet) {
  if (packet.empty()) return std::string(kBad);
  const bool general = packet.front() == 'g';
  packet.remove_prefix(1);
  const std::size_t wanted = thread_of(packet);
  if (wanted == boards_.size()) return std::string(packet == "0" || packet == "-1" ? kOk : kBad);
  if (general) chosen_ = wanted;
  return std::string(kOk);
}

std::string GdbServer::query(std::string_view packet) {
  std::string_view rest = packet;
  if (packet.starts_with("Supported")) {
    return fmt::format(
        "PacketSize={:x};qXfer:features:read+;qXfer:memory-map:read+;qXfer:threads:read+;"
        "QStartNoAckMode+;vContSupported+;ReverseStep+;ReverseContinue+",
        kPacketBytes);
  }
  if (take_word(rest, "Xfer:")) return transfer(rest);
  if (packet.starts_with("Attached")) return "1";
  if (packet == "C") return fmt::format("QC{:x}", chosen_ + 1);
  if (packet == "fThreadInfo") {
    std::string ids = "m";
    for (std::size_t i = 0; i < boards_.size(); ++i) ids += fmt::format("{}{:x}", i == 0 ? "" : ",", i + 1);
    return ids;
  }
  if (packet == "sThreadInfo") return "l";
  if (take_word(rest, "ThreadExtraInfo,")) {
    const std::size_t of = thread_of(rest);
    return of < boards_.size() ? text_as_hex(boards_[of].name()) : std::string(kBad);
  }
  if (packet.starts_with("Symbol")) return std::string(kOk);
  return std::string(kUnknown);
}

std::string GdbServer::transfer(std::string_view packet) const {
  if (take_word(packet, "features:read:target.xml:")) return part_of(gdb_target_xml(registers_), packet);
  if (take_word(packet, "memory-map:read::"))
    return part_of(gdb_memory_map_xml(boards_[chosen_].is.machine->memory()), packet);
  if (take_word(packet, "threads:read::")) return part_of(threads_xml(), packet);
  return std::string(kUnknown);
}

std::string GdbServer::threads_xml() const {
  std::string xml = "<?xml version=\"1.0\"?>\n<threads>\n";
  for (std::size_t i = 0; i < boards_.size(); ++i)
    xml += fmt::format("<thread id=\"{:x}\" name=\"{}\"/>\n", i + 1, boards_[i].name());
  return xml + "</threads>\n";
}

// As much as there is from the address on.
std::string GdbServer::read_memory(std::string_view packet) {
  const auto place = take_place(packet);
  if (!place) return std::string(kBad);
  std::vector<std::uint8_t> bytes(place->bytes);
  std::size_t got = 0;
  while (got < bytes.size() &&
         chosen().peek(place->address + static_cast<std::uint32_t>(got), std::span(bytes).subspan(got, 1)))
    ++got;
  if (got == 0 && !bytes.empty()) return std::string(kNotThere);
  return to_hex(std::span(bytes).first(got));
}

std::string GdbServer::write_memory(std::string_view packet, bool binary) {
  const auto place = take_place(packet);
  if (!place || !take_word(packet, ":")) return std::string(kBad);
  std::vector<std::uint8_t> bytes(packet.begin(), packet.end());
  if (!binary && !parse_hex(packet, bytes)) return std::string(kBad);
  if (bytes.size() != place->bytes || past_) return std::string(kBad);
  if (!bytes.empty()) changed();
  return std::string(bytes.empty() || chosen().poke(place->address, bytes) ? kOk : kNotThere);
}

std::string GdbServer::all_registers() {
  std::string text;
  for (const GdbRegister& r : registers_) text += hex_of(r.get(chosen().cpu()), r.bytes);
  return text;
}

std::string GdbServer::write_all_registers(std::string_view digits) {
  std::vector<std::uint8_t> bytes;
  if (!parse_hex(digits, bytes) || past_) return std::string(kBad);
  changed();
  std::size_t at = 0;
  for (const GdbRegister& r : registers_) {
    if (at + r.bytes > bytes.size()) return std::string(kBad);
    const std::uint64_t value = value_of(std::span(bytes).subspan(at, r.bytes));
    if (r.write != nullptr && value != r.get(chosen().cpu())) r.write(chosen().cpu(), r.index, value);
    at += r.bytes;
  }
  return std::string(kOk);
}

std::string GdbServer::read_register(std::string_view packet) {
  const auto n = take_hex(packet);
  if (!n || *n >= registers_.size()) return std::string(kBad);
  return hex_of(registers_[*n].get(chosen().cpu()), registers_[*n].bytes);
}

std::string GdbServer::write_register(std::string_view packet) {
  const auto n = take_hex(packet);
  std::vector<std::uint8_t> bytes;
  if (!n || *n >= registers_.size() || !take_word(packet, "=") || !parse_hex(packet, bytes))
    return std::string(kBad);
  const GdbRegister& r = registers_[*n];
  if (r.write == nullptr || bytes.size() != r.bytes || past_) return std::string(kBad);
  changed();
  r.write(chosen().cpu(), r.index, value_of(bytes));
  return std::string(kOk);
}

// kind,address,bytes: 0 and 1 halt at an instruction, 2 at writes, 3 at reads, 4 at both.
std::string GdbServer::change_point(std::string_view packet, bool insert) {
  const auto kind = take_hex(packet);
  if (!kind || *kind > 4 || !take_word(packet, ",")) return std::string(kUnknown);
  const auto place = take_place(packet);
  if (!place) return std::string(kBad);
  if (*kind <= 1) {
    std::erase(breakpoints_, place->address & ~1u);
    if (insert) breakpoints_.push_back(place->address & ~1u);
    return std::string(kOk);
  }
  constexpr std::uint8_t kKinds[] = {mcu::kWrites, mcu::kReads, mcu::kReads | mcu::kWrites};
  const mcu::AccessWatch watch{place->address, std::max(place->bytes, 1u), kKinds[*kind - 2]};
  std::erase(watches_, watch);
  if (insert) watches_.push_back(watch);
  return std::string(kOk);
}

void GdbServer::monitor(const std::string& words) {
  bool reset = false;
  std::string said;
  if (words == "reverse on" || words == "reverse off") {
    keeps_past_ = words == "reverse on";
    said = fmt::format("{}\n", words);
  } else {
    said = gdb_monitor(words, boards_[chosen_].is, reset);
  }
  if (reset && past_) said = "the past is only looked at\n";
  if (reset && !past_) {
    changed();
    chosen().reset("debugger");
  }
  if (!said.empty()) send("O" + text_as_hex(said));
  send(kOk);
}

}  // namespace omnihil
