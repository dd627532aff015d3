#include "tools/format_argument.h"

#include <cstdio>
#include <vector>

#include "hil/radio_file/radio_file.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

void complain(const std::string& what, const std::string& word, const std::vector<std::string_view>& names) {
  const std::string near(nearest_spelling(word, names));
  std::string all;
  for (std::string_view name : names) all += "\n  " + std::string(name);
  std::fprintf(stderr, "omnihil: no %s '%s'%s; there are:%s\n", what.c_str(), word.c_str(),
               near.empty() ? "" : ("; did you mean '" + near + "'?").c_str(), all.c_str());
}

}  // namespace

const RadioFormat* format_or_complain(const std::string& id) {
  const RadioFormat* format = find_radio_format(id);
  if (format != nullptr) return format;
  std::vector<std::string_view> names;
  for (const RadioFormat* known : radio_formats()) names.push_back(known->id);
  complain("radio format", id, names);
  return nullptr;
}

const RadioFormat* format_file_or_complain(const std::string& path) {
  const RadioFile file = load_radio_file(path);
  for (const ModelProblem& problem : file.problems) std::fprintf(stderr, "%s\n", problem.text().c_str());
  if (file.format != nullptr) use_radio_format(*file.format);
  return file.format;
}

const RadioFormat* format_or_complain(const std::string& id, const std::string& file) {
  if (!file.empty()) return format_file_or_complain(file);
  if (!id.empty()) return format_or_complain(id);
  std::fprintf(stderr, "omnihil: FORMAT is required, or --format FILE; see `omnihil formats`\n");
  return nullptr;
}

const Message* message_or_complain(const RadioFormat& format, const std::string& name) {
  const Message* message = format.find(name);
  if (message != nullptr) return message;
  std::vector<std::string_view> names;
  for (const Message& known : format.messages) names.push_back(known.name);
  complain("packet of " + std::string(format.id), name, names);
  return nullptr;
}

}  // namespace omnihil
