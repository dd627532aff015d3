#include "firmware_iface/mcu/machine/elf_image.h"

#include <fmt/format.h>

namespace omnihil::mcu {
namespace {

constexpr std::size_t kHeaderBytes = 52, kSegmentBytes = 32, kSectionBytes = 40, kSymbolBytes = 16;
constexpr std::uint32_t kLoad = 1, kSymbolTable = 2;

class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> file) : file_(file) {}
  std::size_t size() const { return file_.size(); }
  bool holds(std::uint64_t at, std::uint64_t bytes) const {
    return at <= file_.size() && bytes <= file_.size() - at;
  }
  std::uint32_t u8(std::uint64_t at) const { return holds(at, 1) ? file_[at] : 0u; }
  std::uint32_t u16(std::uint64_t at) const { return u8(at) | u8(at + 1) << 8; }
  std::uint32_t u32(std::uint64_t at) const { return u16(at) | u16(at + 2) << 16; }
  std::span<const std::uint8_t> part(std::size_t at, std::size_t bytes) const {
    return file_.subspan(at, bytes);
  }
  std::string text(std::uint64_t at, std::uint64_t end) const {
    std::string result;
    while (at < end && at < file_.size() && file_[at] != 0) result += static_cast<char>(file_[at++]);
    return result;
  }

 private:
  std::span<const std::uint8_t> file_;
};

void check_header(const Bytes& file, ElfMachine machine, std::vector<std::string>& problems) {
  if (file.size() < kHeaderBytes) {
    problems.push_back(
        fmt::format("not an ELF file: {} bytes, the header alone has {}", file.size(), kHeaderBytes));
    return;
  }
  if (file.u32(0) != 0x464C457F) {
    problems.push_back("not an ELF file: it does not begin with 7F 'E' 'L' 'F'");
    return;
  }
  if (file.u8(4) != 1) problems.push_back(fmt::format("ELF class is {}, allowed: 1 (32 bit)", file.u8(4)));
  if (file.u8(5) != 1)
    problems.push_back(fmt::format("byte order is {}, allowed: 1 (little-endian)", file.u8(5)));
  const unsigned wanted = static_cast<unsigned>(machine);
  if (file.u16(18) != wanted) {
    problems.push_back(fmt::format("machine is {}, allowed: {} ({})", file.u16(18), wanted,
                                   machine == ElfMachine::kArm ? "ARM" : "AVR"));
  }
  if (file.u16(16) != 2) {
    problems.push_back(fmt::format("type is {}, allowed: 2 (executable); link it first", file.u16(16)));
  }
  if (file.u16(42) < kSegmentBytes && file.u16(44) != 0) {
    problems.push_back(fmt::format("program header size is {}, at least {}", file.u16(42), kSegmentBytes));
  }
}

void read_segments(const Bytes& file, ElfImage& image, std::vector<std::string>& problems) {
  const std::uint64_t table = file.u32(28), entry_bytes = file.u16(42), count = file.u16(44);
  if (!file.holds(table, entry_bytes * count)) {
    problems.push_back(fmt::format("truncated: {} program headers at {} reach beyond the file's {} bytes",
                                   count, table, file.size()));
    return;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t at = table + i * entry_bytes;
    if (file.u32(at) != kLoad) continue;
    const std::uint32_t offset = file.u32(at + 4), address = file.u32(at + 12), bytes = file.u32(at + 16);
    if (file.u32(at + 20) != 0) image.occupied.push_back({file.u32(at + 8), file.u32(at + 20)});
    if (bytes == 0) continue;
    if (!file.holds(offset, bytes)) {
      problems.push_back(
          fmt::format("truncated: segment {} ({} bytes at {}) reaches beyond the file's {} bytes", i, bytes,
                      offset, file.size()));
      continue;
    }
    if (bytes > file.u32(at + 20)) {
      problems.push_back(
          fmt::format("segment {}: {} bytes in the file, {} in memory; allowed: no more in the file", i,
                      bytes, file.u32(at + 20)));
      continue;
    }
    const auto part = file.part(offset, bytes);
    image.segments.push_back({address, {part.begin(), part.end()}});
  }
  if (image.segments.empty() && problems.empty()) problems.push_back("nothing to load: no segment has bytes");
}

void read_symbols(const Bytes& file, ElfImage& image) {
  const std::uint64_t table = file.u32(32), entry_bytes = file.u16(46), count = file.u16(48);
  if (entry_bytes < kSectionBytes || !file.holds(table, entry_bytes * count)) return;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t section = table + i * entry_bytes;
    if (file.u32(section + 4) != kSymbolTable) continue;
    const std::uint64_t begin = file.u32(section + 16), bytes = file.u32(section + 20),
                        link = file.u32(section + 24);
    if (!file.holds(begin, bytes) || link >= count) continue;
    const std::uint64_t names = table + link * entry_bytes;
    const std::uint64_t names_begin = file.u32(names + 16), names_end = names_begin + file.u32(names + 20);
    for (std::uint64_t at = begin; at + kSymbolBytes <= begin + bytes; at += kSymbolBytes) {
      const std::string name = file.text(names_begin + file.u32(at), names_end);
      if (name.empty() || name[0] == '$' || file.u16(at + 14) == 0) continue;
      const std::uint32_t value = file.u32(at + 4);
      image.symbols.emplace(name, value);
      if ((file.u8(at + 12) & 15) == 2) image.functions.emplace(value & ~1u, name);
    }
  }
}

}  // namespace

std::optional<std::uint32_t> ElfImage::address_of(std::string_view name) const {
  const auto found = symbols.find(name);
  return found == symbols.end() ? std::nullopt : std::optional(found->second);
}

std::string ElfImage::function_at(std::uint32_t pc) const {
  auto after = functions.upper_bound(pc);
  if (after == functions.begin()) return {};
  --after;
  return pc == after->first ? after->second : fmt::format("{}+0x{:x}", after->second, pc - after->first);
}

bool read_elf(std::span<const std::uint8_t> file, ElfImage& image, std::vector<std::string>& problems,
              ElfMachine machine) {
  image = ElfImage{};
  const std::size_t before = problems.size();
  const Bytes bytes(file);
  check_header(bytes, machine, problems);
  if (problems.size() != before) return false;
  image.entry = bytes.u32(24);
  std::vector<std::string> found;
  read_segments(bytes, image, found);
  problems.insert(problems.end(), found.begin(), found.end());
  if (!found.empty()) return false;
  read_symbols(bytes, image);
  return true;
}

}  // namespace omnihil::mcu
