#include "tools/options/open_end.h"

#include <fmt/format.h>

#include <system_error>
#include <vector>

#include "hil/loop/session_checks.h"
#include "hil/wire/open_wire.h"

namespace omnihil {

std::unique_ptr<ByteWire> open_end(const std::string& text, const char* bare, const char* option) {
  const WireUrl url = read_wire_url(text, bare);
  std::vector<std::string> problems = wire_problems(url, WireForm::kBytes);
  for (std::string& problem : problems) problem = fmt::format("{}: {}", option, problem);
  throw_problems(problems);
  WireProblem problem;
  std::unique_ptr<ByteWire> wire = open_byte_wire(url, {}, problem);
  if (!wire)
    throw std::system_error(std::make_error_code(std::errc::io_error),
                            fmt::format("{}: {}", option, problem.text()));
  return wire;
}

}  // namespace omnihil
