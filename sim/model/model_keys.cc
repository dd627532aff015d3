#include "sim/model/model_keys.h"

#include <fmt/format.h>

#include "sim/model/model_rows.h"

namespace omnihil {
namespace {

std::string rigs_of(std::uint32_t rigs) {
  std::string out;
  const auto add = [&](std::uint32_t bit, const char* letter) {
    if ((rigs & bit) != 0) out += (out.empty() ? "" : " ") + std::string(letter);
  };
  add(kRigRobot, "R");
  add(kRigAxis, "A");
  add(kRigLinearAxis, "L");
  add(kRigMotor, "M");
  return out;
}

std::string default_of(const ParameterRow& row) {
  if (row.needed != 0) return fmt::format("needed ({})", rigs_of(row.needed));
  if (row.kind == ParameterKind::kTruth) return "false";
  if (row.kind == ParameterKind::kChoice) {
    return fmt::format("\"{}\"", row.choices[static_cast<std::size_t>(*row.otherwise)]);
  }
  return row.otherwise ? fmt::format("{:g}", *row.otherwise) : "none";
}

std::string range_of(const ParameterRow& row) {
  switch (row.kind) {
    case ParameterKind::kText:
      return "text";
    case ParameterKind::kTruth:
      return "true, false";
    case ParameterKind::kWheelNumbers:
      return fmt::format("{} to {} numbers, {}", kMinWheels, kMaxWheels, allowed_range(row));
    default:
      return allowed_range(row);
  }
}

}  // namespace

std::string model_keys_markdown() {
  std::string out;
  std::string_view section = "?";
  for (const ParameterRow& row : model_rows()) {
    if (row.section != section) {
      section = row.section;
      out += section.empty() ? "\n### At the top of the file\n\n" : fmt::format("\n### `[{}]`\n\n", section);
      out +=
          "| key | rigs | default | allowed | what it is | how to measure it |\n|---|---|---|---|---|---|\n";
    }
    out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key, rigs_of(row.rigs), default_of(row),
                       range_of(row), row.what, row.how);
  }
  return out.substr(1);
}

}  // namespace omnihil
