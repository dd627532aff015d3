#include "hil/card/provenance.h"

#include <algorithm>
#include <cctype>

#include "hil/text/text_file.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostReadme = 20'000;  // a choice: a README is short

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string stripped(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n*");
  const auto last = text.find_last_not_of(" \t\r\n*");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string first_line(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = stripped(text.substr(at, end - at));
    if (!line.empty()) return line;
    at = end + 1;
  }
  return "";
}

std::string text_of_file(const std::filesystem::path& path) {
  std::string error;
  std::string text = read_text_file(path, error);
  return error.empty() ? text : "";
}

}  // namespace

std::string stated_in(std::string_view text, std::string_view word) {
  const std::string small = lower(text);
  const std::string key = std::string(word) + ":";
  const std::size_t at = small.find(key);
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size();
  std::size_t end = std::min(small.find('\n', from), small.size());
  // Another key on the same line ends the statement.
  for (const char* other : {"licence:", "license:", "source:"}) {
    const std::size_t next = small.find(other, from);
    if (next != std::string::npos && next < end) end = next;
  }
  return stripped(std::string(text.substr(from, end - from)));
}

Provenance provenance_of(const std::filesystem::path& folder) {
  Provenance out;
  out.readme = text_of_file(folder / "README.md").substr(0, kMostReadme);
  out.source = stated_in(out.readme, "source");
  out.licence = stated_in(out.readme, "licence");
  if (out.licence.empty()) out.licence = stated_in(out.readme, "license");
  for (const char* name : {"LICENSE", "LICENCE", "LICENSE.txt"}) {
    const std::string line = first_line(text_of_file(folder / name));
    if (line.empty()) continue;
    out.licence += (out.licence.empty() ? "" : " ") + std::string("(file ") + name + ": " + line + ")";
    break;
  }
  return out;
}

}  // namespace omnihil
