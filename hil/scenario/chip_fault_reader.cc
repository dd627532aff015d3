#include "hil/scenario/chip_fault_reader.h"

#include <fmt/format.h>

namespace omnihil {
namespace {

constexpr std::int64_t kMostBoards = 255, kLastAddress = 0xFFFFFFFFLL, kLastIrq = 239;
constexpr double kFastest_Hz = 1e6;

void need(TomlKeys& keys, const toml::table& t, const std::string& path, std::string_view key,
          const std::string& allowed) {
  if (t.get(key) == nullptr) keys.missing(t, path, key, allowed);
}

std::uint32_t whole(TomlKeys& keys, const toml::table& t, const std::string& path, std::string_view key,
                    std::int64_t most, bool needed) {
  const toml::node* node = t.get(key);
  const std::string allowed = fmt::format("allowed: a whole number, 0 to {}", most);
  if (needed) need(keys, t, path, key, allowed);
  if (node == nullptr) return 0;
  const auto value = node->value_exact<std::int64_t>();
  if (value && *value >= 0 && *value <= most) return static_cast<std::uint32_t>(*value);
  keys.wrong(*node, key_path(path, key), "is not allowed here", allowed);
  return 0;
}

}  // namespace

void read_chip_fault(TomlKeys& keys, const toml::table& t, const std::string& path, ChipFault& f) {
  f.board = whole(keys, t, path, "board", kMostBoards, false);
  switch (f.kind) {
    case ChipFaultKind::kRamBit:
    case ChipFaultKind::kFlashBit:
      f.address = whole(keys, t, path, "address", kLastAddress, true);
      f.bit = whole(keys, t, path, "bit", 7, true);
      break;
    case ChipFaultKind::kRegisterBit:
      f.reg = whole(keys, t, path, "register", 14, true);
      f.bit = whole(keys, t, path, "bit", 31, true);
      break;
    case ChipFaultKind::kClockOff:
    case ChipFaultKind::kWatchdogLate:
      need(keys, t, path, "ratio", "a part of the usual rate");
      f.ratio = keys.number(t, path, "ratio", 0.01, 10.0, false, "allowed: 0.01 to 10").value_or(1.0);
      break;
    case ChipFaultKind::kInterruptStorm:
      f.irq = static_cast<std::int32_t>(whole(keys, t, path, "irq", kLastIrq, true));
      need(keys, t, path, "rate_Hz", "above 0 to 1e6");
      f.rate_Hz =
          keys.number(t, path, "rate_Hz", 0.0, kFastest_Hz, true, "allowed: above 0 to 1e6").value_or(1.0);
      break;
    default:
      break;
  }
}

std::string value_text(TomlKeys& keys, const toml::table& t, const std::string& path) {
  need(keys, t, path, "value", "a number, true, false, or an enumerator's name");
  const toml::node* node = t.get("value");
  if (node == nullptr) return {};
  if (const auto number = node->value_exact<std::int64_t>()) return fmt::format("{}", *number);
  if (const auto number = node->value_exact<double>()) return fmt::format("{}", *number);
  if (const auto truth = node->value_exact<bool>()) return *truth ? "true" : "false";
  return keys.text(t, path, "value").value_or("");
}

}  // namespace omnihil
