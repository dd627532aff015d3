#include "tools/manual.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/completion.h"
#include "tools/man_page.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::system_error(std::make_error_code(std::errc::io_error), path.string());
}

}  // namespace

void write_manual(const Command& program, const std::string& version, const std::string& folder) {
  const fs::path share = fs::path(folder) / "share", pages = share / "man/man1";
  write(pages / (man_page_name(program) + ".1"), man_page(program, version));
  for (const Command& verb : program.verbs)
    write(pages / (man_page_name(verb) + ".1"), man_page(verb, version));
  write(share / "bash-completion/completions/omnihil", bash_completion(program));
  write(share / "fish/vendor_completions.d/omnihil.fish", fish_completion(program));
}

}  // namespace omnihil
