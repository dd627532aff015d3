// Images that are no images: every one is refused with a reason, none does harm.
#include "firmware_iface/mcu/machine/elf_image.h"

#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& file, std::size_t at, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i)
    file[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
}

constexpr std::size_t kSegment = 52, kContents = 84;

// The smallest image: a header, one segment of 16 bytes at the beginning of the flash.
Bytes small_image(std::uint32_t address = 0x08000000) {
  Bytes file(kContents + 16);
  put(file, 0, 0x464C457F, 4);
  put(file, 4, 0x00010101, 4);
  put(file, 16, 2, 2);
  put(file, 18, 40, 2);
  put(file, 20, 1, 4);
  put(file, 24, address + 9, 4);
  put(file, 28, kSegment, 4);
  put(file, 42, 32, 2);
  put(file, 44, 1, 2);
  put(file, kSegment, 1, 4);
  put(file, kSegment + 4, kContents, 4);
  put(file, kSegment + 8, address, 4);
  put(file, kSegment + 12, address, 4);
  put(file, kSegment + 16, 16, 4);
  put(file, kSegment + 20, 16, 4);
  put(file, kContents, 0x20001000, 4);
  put(file, kContents + 4, address + 9, 4);
  put(file, kContents + 8, 0xE7FE, 2);  // b .
  return file;
}

std::string problem_of(const Bytes& file) {
  ElfImage image;
  std::vector<std::string> problems;
  if (!read_elf(file, image, problems)) return problems.empty() ? "refused without a reason" : problems[0];
  Machine machine({});
  if (!machine.load(image, problems)) return problems.empty() ? "refused without a reason" : problems[0];
  return "";
}

TEST(ElfImageTest, TheSmallestImageRuns) {
  ElfImage image;
  std::vector<std::string> problems;
  ASSERT_TRUE(read_elf(small_image(), image, problems));
  Machine machine({});
  ASSERT_TRUE(machine.load(image, problems));
  machine.power_on();
  machine.run_until(1000);
  EXPECT_EQ(machine.cpu().reg.r[15], 0x08000008u);
  EXPECT_EQ(machine.report().fault_count, 0u);
}

struct Broken {
  std::size_t at;
  std::uint32_t value;
  int bytes;
  const char* says;
};

TEST(ElfImageTest, EachBrokenFieldIsNamed) {
  const Broken kBroken[] = {
      {0, 0x7F, 4, "not an ELF file"},
      {4, 2, 1, "class is 2"},
      {5, 2, 1, "byte order is 2"},
      {16, 1, 2, "type is 1"},
      {18, 62, 2, "machine is 62"},
      {42, 8, 2, "program header size is 8"},
      {44, 0, 2, "nothing to load"},
      {44, 0xFFFF, 2, "truncated: 65535 program headers"},
      {28, 0xFFFFFFF0, 4, "truncated"},
      {kSegment + 4, 0x1000, 4, "truncated: segment 0"},
      {kSegment + 16, 0xFFFFFFFF, 4, "truncated: segment 0"},
      {kSegment + 20, 8, 4, "16 bytes in the file, 8 in memory"},
      {kSegment + 12, 0x40000000, 4, "no memory there"},
      {kSegment + 12, 0x080FFFF8, 4, "reaches to 0x08100000"},
      {kContents, 0x60000000, 4, "initial stack pointer 0x60000000"},
      {kContents + 4, 0x08000008, 4, "reset vector 0x08000008"},
      {kContents + 4, 0x90000001, 4, "reset vector 0x90000001"},
  };
  for (const Broken& broken : kBroken) {
    Bytes file = small_image();
    put(file, broken.at, broken.value, broken.bytes);
    EXPECT_NE(problem_of(file).find(broken.says), std::string::npos)
        << broken.says << " / " << problem_of(file);
  }
}

TEST(ElfImageTest, EveryTruncationIsRefusedOrHarmless) {
  const Bytes whole = small_image();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(problem_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}), "") << length;
  }
}

TEST(ElfImageTest, MutatedImagesNeverHarm) {
  OMNIHIL_NEED_IMAGES();
  const Bytes whole = image_bytes("exceptions");
  std::uint64_t state = 1;
  const auto next = [&] { return (state = state * 6364136223846793005u + 1442695040888963407u) >> 33; };
  int refused = 0, ran = 0;
  for (int i = 0; i < 300; ++i) {
    Bytes file = whole;
    for (int k = 0; k < 12; ++k)
      file[next() % (k < 3 ? 200 : file.size())] = static_cast<std::uint8_t>(next());
    ElfImage image;
    std::vector<std::string> problems;
    MachineConfig config;
    config.flash_bytes = 64 << 10;
    Machine machine(config);
    if (!read_elf(file, image, problems) || !machine.load(image, problems)) {
      EXPECT_FALSE(problems.empty());
      ++refused;
      continue;
    }
    machine.power_on();
    machine.run_until(20'000);
    EXPECT_GE(machine.now(), 20'000u);
    ++ran;
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(ran, 10);
}

}  // namespace
}  // namespace omnihil::mcu
