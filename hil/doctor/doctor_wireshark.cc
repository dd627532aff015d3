// Wireshark: is it there, and does it load the dissectors of our radio formats.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hil/doctor/doctor.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
// What every dissector that `formats ID --wireshark` writes registers for.
constexpr std::string_view kDissectorSign = "wtap.USER0";

std::string home() {
  const char* folder = std::getenv("HOME");
  return folder == nullptr ? "" : folder;
}

bool is_dissector(const fs::path& file) {
  if (file.extension() != ".lua") return false;
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str().find(kDissectorSign) != std::string::npos;
}

std::size_t dissectors_in(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    count += is_dissector(at->path()) ? 1 : 0;
  return count;
}

}  // namespace

std::vector<std::string> folders_of_programs() {
  const char* path = std::getenv("PATH");
  std::istringstream all(path == nullptr ? "" : path);
  std::vector<std::string> folders;
  for (std::string folder; std::getline(all, folder, ':');) folders.push_back(folder);
  return folders;
}

// Source: Wireshark User's Guide, appendix B.5, plugin folders; Debian's multi-arch path is searched as it stands.
std::vector<std::string> wireshark_plugin_folders() {
  std::vector<std::string> folders{home() + "/.local/lib/wireshark/plugins",
                                   home() + "/.config/wireshark/plugins", "/usr/lib/wireshark/plugins",
                                   "/usr/local/lib/wireshark/plugins"};
  std::error_code error;
  for (fs::directory_iterator at("/usr/lib", error), end; !error && at != end; at.increment(error)) {
    if (fs::is_directory(at->path() / "wireshark/plugins", error))
      folders.push_back((at->path() / "wireshark/plugins").string());
  }
  return folders;
}

Finding look_at_wireshark(const std::vector<std::string>& program_path,
                          const std::vector<std::string>& plugin_folders) {
  std::string program;
  for (const std::string& folder : program_path) {
    for (const char* name : {"/wireshark", "/tshark"}) {
      if (program.empty() && ::access((folder + name).c_str(), X_OK) == 0) program = folder + name;
    }
  }
  if (program.empty()) {
    return {"Wireshark", FindingState::kLimited,
            "not installed; captures (convert --to pcap) are written all the same",
            "sudo apt install tshark"};
  }
  for (const std::string& folder : plugin_folders) {
    if (const std::size_t count = dissectors_in(folder); count > 0)
      return {"Wireshark", FindingState::kOk, fmt::format("{}; {} dissectors in {}", program, count, folder),
              ""};
  }
  return {"Wireshark", FindingState::kLimited, program + "; no dissector of ours in its plugin folders",
          "f=~/.local/lib/wireshark/plugins; mkdir -p $f && omnihil formats ulaval-hermes --wireshark > "
          "$f/ulaval-hermes.lua"};
}

}  // namespace omnihil
