#include "hil/card/card_gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hil/card/card_page.h"
#include "hil/text/json_text.h"
#include "hil/text/markup.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCardSuffix = ".card.json";
constexpr std::size_t kShownDigits = 12;

std::string word(const Json& at, const char* key) {
  const auto it = at.find(key);
  return it != at.end() && it->is_string() ? it->get<std::string>() : "";
}

// An element that should be a list, or an empty one.
const Json& list(const Json& at, const char* key) {
  static const Json kNone = Json::array();
  const auto it = at.find(key);
  return it != at.end() && it->is_array() ? *it : kNone;
}

std::string effect_words(const Json& effect) {
  const Json& evidence = list(effect, "evidence");
  const bool tested =
      std::any_of(evidence.begin(), evidence.end(), [](const Json& e) { return e.value("tested", false); });
  const bool earns = std::any_of(evidence.begin(), evidence.end(),
                                 [](const Json& e) { return e.value("earns_its_place", false); });
  return word(effect, "effect") + (tested && !earns ? " (earns no place)" : tested ? "" : " (not tested)");
}

std::string read_card(const fs::path& path, StoredCard& card) {
  std::string error;
  const std::string text = read_text_file(path, error);
  if (!error.empty()) return error;
  const Json json = json_of(text);
  if (json.is_discarded() || !json.is_object()) return "is no JSON object";
  if (word(json, "format") != "omnihil-card/1")
    return fmt::format("format = \"{}\"; allowed: \"omnihil-card/1\"", word(json, "format"));
  card.json = path;
  card.name = word(json, "name");
  card.title = word(json, "title");
  card.rig = word(json, "rig");
  card.sentence = word(json, "sentence");
  card.date = word(json, "date");
  try {
    for (const Json& file : list(json, "files"))
      card.files.push_back({word(file, "name"), word(file, "sha256")});
    for (const Json& effect : list(json, "effects")) card.effects.push_back(effect_words(effect));
    for (const Json& data : list(json, "data")) card.datasets.push_back(word(data, "name"));
  } catch (const Json::exception& wrong) {  // a value of another type than the format has there
    return wrong.what();
  }
  if (card.files.empty()) return "files is empty; allowed: the model's file with its sha256";
  return "";
}

std::vector<std::string> stale_notes(const StoredCard& card) {
  std::vector<std::string> out;
  for (const HashedFile& file : card.files) {
    const fs::path path = (card.json.parent_path() / file.name).lexically_normal();
    if (!fs::exists(path)) {
      out.push_back(fmt::format("{}: is not there any more; its card {} is of {}", path.string(),
                                card.json.filename().string(), card.date));
      continue;
    }
    const std::string now = hash_file(path.string()).sha256;
    if (now == file.sha256) continue;
    out.push_back(fmt::format("{}: was edited since its card {} was made on {} (sha256 {}, then {})",
                              path.string(), card.json.filename().string(), card.date,
                              now.substr(0, kShownDigits), file.sha256.substr(0, kShownDigits)));
  }
  return out;
}

bool is_card(const fs::path& path) { return path.filename().string().ends_with(kCardSuffix); }

std::string joined(const std::vector<std::string>& words, const char* none) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : ", ") + escaped(w);
  return out.empty() ? none : out;
}

}  // namespace

CardFolder read_cards(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) {
      for (const fs::directory_entry& below : fs::directory_iterator(entry)) {
        if (is_card(below.path())) paths.push_back(below.path());
      }
    } else if (is_card(entry.path())) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  CardFolder out;
  for (const fs::path& path : paths) {
    StoredCard card;
    const std::string fault = read_card(path, card);
    if (fault.empty()) {
      out.cards.push_back(std::move(card));
    } else {
      out.problems.push_back(path.string() + ": " + fault);
    }
  }
  return out;
}

std::vector<std::string> stale_card_notes(const fs::path& model_file) {
  const fs::path folder = model_file.has_parent_path() ? model_file.parent_path() : fs::path(".");
  std::vector<std::string> out;
  if (!fs::is_directory(folder)) return out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!is_card(entry.path())) continue;
    StoredCard card;
    if (!read_card(entry.path(), card).empty() || card.files.front().name != model_file.filename().string())
      continue;
    for (std::string& note : stale_notes(card)) out.push_back(std::move(note));
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::string gallery_html(const CardFolder& cards, const fs::path& page) {
  const fs::path from = fs::absolute(page).parent_path();
  std::string table =
      "<table class=\"wide\"><caption>Models</caption><thead><tr><th scope=\"col\">model</th><th "
      "scope=\"col\">rig</th><th "
      "scope=\"col\">error on data it was not fitted to</th><th scope=\"col\">effects</th><th "
      "scope=\"col\">data</th><th "
      "scope=\"col\">made</th></tr></thead><tbody>\n";
  for (const StoredCard& card : cards.cards) {
    fs::path html = card.json;
    html.replace_extension(".html");
    const std::string link = fs::absolute(html).lexically_relative(from).generic_string();
    std::string marks;
    for (const std::string& note : stale_notes(card))
      marks += "<br><span class=\"mark\">" + escaped(note) + "</span>";
    const std::string title = escaped(card.title.empty() ? card.name : card.title);
    table += fmt::format(
        "<tr><th scope=\"row\">{}{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        fs::exists(html) ? fmt::format("<a href=\"{}\">{}</a>", escaped(link), title) : title, marks,
        escaped(card.rig), escaped(card.sentence), joined(card.effects, "none"),
        joined(card.datasets, "none"), escaped(card.date));
  }
  table += "</tbody></table>\n";
  return card_page("Model cards", {{"models", fmt::format("{} models", cards.cards.size()), table}},
                   "<h1>Model cards</h1>\n");
}

}  // namespace omnihil
