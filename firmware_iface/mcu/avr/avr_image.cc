#include "firmware_iface/mcu/avr/avr_image.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace omnihil::mcu {
namespace {

constexpr std::size_t kMostFlash = 256 * 1024;

bool is_elf(std::span<const std::uint8_t> file) {
  return file.size() >= 20 && file[0] == 0x7F && file[1] == 'E' && file[2] == 'L' && file[3] == 'F';
}

// ":LLAAAATT" + data + checksum, all in hexadecimal; the sum of a record's bytes is 0.
bool record_bytes(std::string_view line, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  if (line.size() < 11 || line[0] != ':' || line.size() % 2 != 1) return false;
  unsigned sum = 0;
  for (std::size_t i = 1; i < line.size(); i += 2) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(line.data() + i, line.data() + i + 2, value, 16);
    if (error != std::errc{} || end != line.data() + i + 2) return false;
    bytes.push_back(static_cast<std::uint8_t>(value));
    sum += value;
  }
  return bytes.size() == bytes[0] + 5u && sum % 256 == 0;
}

bool read_hex(std::string_view text, AvrImage& image, std::vector<std::string>& problems) {
  std::uint32_t base = 0;
  std::size_t number = 0;
  bool ended = false;
  std::vector<std::uint8_t> r;
  while (!text.empty() && !ended) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty()) continue;
    if (!record_bytes(line, r)) {
      problems.push_back(fmt::format("line {}: not a record of Intel HEX, or its sum is wrong", number));
      return false;
    }
    const std::uint32_t address = r[1] * 256u + r[2];
    const unsigned type = r[3];
    if (type == 1) ended = true;
    if (type == 2 && r[0] == 2) base = (r[4] * 256u + r[5]) * 16;
    if (type == 4 && r[0] == 2) base = (r[4] * 256u + r[5]) << 16;
    if (type > 5) {
      problems.push_back(fmt::format("line {}: record type {}, allowed: 0 to 5", number, type));
      return false;
    }
    if (type != 0 || r[0] == 0) continue;
    if (base + address + r[0] > kMostFlash) {
      problems.push_back(
          fmt::format("line {}: address 0x{:x}, allowed: below 0x{:x}", number, base + address, kMostFlash));
      return false;
    }
    image.flash.push_back({base + address, {r.begin() + 4, r.end() - 1}});
  }
  if (!ended) problems.push_back("truncated: the record that ends an Intel HEX file is missing");
  if (ended && image.flash.empty()) problems.push_back("nothing to load: no record has bytes");
  return ended && !image.flash.empty();
}

}  // namespace

bool is_avr_image(std::span<const std::uint8_t> file) {
  if (is_elf(file)) return (file[18] | file[19] << 8) == static_cast<int>(ElfMachine::kAvr);
  return !file.empty() && file[0] == ':';
}

bool read_avr_image(std::span<const std::uint8_t> file, AvrImage& image, std::vector<std::string>& problems) {
  image = AvrImage{};
  if (!is_elf(file)) {
    return read_hex({reinterpret_cast<const char*>(file.data()), file.size()}, image, problems);
  }
  ElfImage elf;
  if (!read_elf(file, elf, problems, ElfMachine::kAvr)) return false;
  image.main = elf.address_of("main");
  for (ElfSegment& segment : elf.segments) {
    if (segment.address < kAvrData) {
      image.flash.push_back(std::move(segment));
    } else if (segment.address >= kAvrEeprom && segment.address < kAvrFuses) {
      segment.address -= kAvrEeprom;
      image.eeprom.push_back(std::move(segment));
    }
  }
  if (image.flash.empty()) problems.push_back("nothing to load: no segment is for the flash");
  return !image.flash.empty();
}

}  // namespace omnihil::mcu
