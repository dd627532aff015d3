#include "hil/logs/log_formats.h"

#include <cstdint>
#include <cstring>

namespace omnihil {
namespace {

// Version 4 has no word at its head: type (a number of four digits, little-endian: below 100), rows, columns, imaginary
// part or not, and the length of a name that ends in a zero (MAT-File Format, The MathWorks, "Level 4").
bool is_mat_4(std::string_view head) {
  std::int32_t type = 0, imaginary = 0, name = 0;
  constexpr std::size_t kHead = 20;
  if (head.size() < kHead + 2) return false;
  std::memcpy(&type, head.data(), sizeof type);
  std::memcpy(&imaginary, head.data() + 12, sizeof imaginary);
  std::memcpy(&name, head.data() + 16, sizeof name);
  return type >= 0 && type < 100 && (imaginary == 0 || imaginary == 1) && name > 1 && name <= 64 &&
         head.size() > kHead + static_cast<std::size_t>(name) &&
         head[kHead + static_cast<std::size_t>(name) - 1] == '\0' && head[kHead] > ' ';
}

constexpr BinaryLog kFormats[] = {
    {[](std::string_view head) { return head.starts_with("WPILOG"); }, read_wpilog},
    {[](std::string_view head) { return head.starts_with("ULog\x01\x12\x35"); }, read_ulog},
    {[](std::string_view head) { return head.starts_with("\x89MCAP0\r\n"); }, read_mcap_log},
    {[](std::string_view head) { return head.starts_with(std::string_view("SQLite format 3\0", 16)); },
     read_rosbag_sqlite},
    {[](std::string_view head) { return head.starts_with("MATLAB ") || is_mat_4(head); }, read_mat_log},
};

}  // namespace

std::span<const BinaryLog> binary_logs() { return kFormats; }

}  // namespace omnihil
