#include "tools/manual.h"

#include <filesystem>

#include "hil/text/text_file.h"
#include "tools/completion.h"
#include "tools/man_page.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  write_text_file(path, text);
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
