// omnihil effects [ID]: lists the physical effects a model can have, or explains one.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "sim/law/effect_registry.h"
#include "sim/pages/effect_page.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string id;
  std::string docs;
};

int list() {
  for (const EffectEntry* e : all_effects()) {
    std::string params;
    for (const EffectParam& row : e->info->params) {
      if (row.role == ParamRole::kDetail) break;
      params += (params.empty() ? "" : ", ") + std::string(row.name);
    }
    std::printf("%-26s %-8s %s (%s)\n", std::string(e->info->id).c_str(),
                std::string(place_name(e->info->place)).c_str(), std::string(e->info->title).c_str(),
                params.c_str());
  }
  std::printf("\n`omnihil effects ID` explains one; `--with ID.parameter=value` adds one to a run.\n");
  return kExitOk;
}

int explain(const std::string& id) {
  const EffectEntry* entry = find_effect(id);
  if (entry == nullptr) {
    const std::string_view near = nearest_effect(id);
    std::fprintf(stderr, "omnihil effects: there is no effect \"%s\"%s\n", id.c_str(),
                 near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near).c_str());
    return kExitBadInput;
  }
  std::fputs(effect_page(*entry).c_str(), stdout);
  return kExitOk;
}

bool write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::fprintf(stderr, "omnihil effects: cannot write %s\n", path.c_str());
  return static_cast<bool>(file);
}

int write_docs(const std::filesystem::path& folder) {
  std::error_code ignored;  // a folder that cannot be made: the first file says so
  std::filesystem::create_directories(folder / "img", ignored);
  bool good = write_file(folder / "index.md", "# All effects\n\n" + effect_index());
  for (const EffectEntry* e : all_effects()) {
    const std::string id(e->info->id);
    good = good && write_file(folder / (id + ".md"), effect_page(*e));
    const std::string picture = effect_picture(*e);
    if (!picture.empty()) good = good && write_file(folder / "img" / (id + ".svg"), picture);
  }
  return good ? kExitOk : kExitIo;
}

int run(const Arguments& arguments) {
  if (!arguments.docs.empty()) return write_docs(arguments.docs);
  return arguments.id.empty() ? list() : explain(arguments.id);
}

}  // namespace

void add_verb_effects(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("effects", "list the physical effects, or explain one");
  const Option id = verb.add_option("ID", arguments->id, "explain this effect (Markdown)");
  verb.add_option("--docs", arguments->docs, "write a page and a picture per effect into this folder")
      .excludes(id);
  verb.callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace omnihil
