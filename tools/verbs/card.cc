// omnihil card MODEL --data DATASET…: a model's passport as a page and as JSON; --gallery lists the cards of a folder.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/card/card_gallery.h"
#include "hil/card/model_card.h"
#include "hil/loop/model_store.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "hil/text/today.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/program_commit.h"
#include "tools/progress_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string model, out, gallery, axes;
  std::vector<std::string> data;
  bool no_evidence = false;
  std::uint64_t seed = 1;
  int jobs = 2;
};

// "speed,abs_current"
std::array<std::string, 2> axes_of(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || comma == 0 || comma + 1 == text.size() ||
      text.find(',', comma + 1) != std::string::npos)
    throw std::invalid_argument(fmt::format(
        "--axes {}: allowed: two names with a comma between them, such as speed,abs_current", text));
  return {text.substr(0, comma), text.substr(comma + 1)};
}

// A path, or a name among the models that come with the program.
std::string model_path(const std::string& model) {
  if (fs::exists(model)) return model;
  const StoredModel stored = load_model(model, {data_folder("models")});
  return stored.bundle.robot_file.empty() ? model : stored.bundle.robot_file;
}

int gallery(const Arguments& a) {
  if (a.out.empty()) throw std::invalid_argument("--gallery: needs --out FILE.html");
  if (!fs::is_directory(a.gallery))
    throw std::system_error(std::make_error_code(std::errc::not_a_directory), a.gallery);
  const CardFolder cards = read_cards(a.gallery);
  for (const std::string& problem : cards.problems)
    std::fprintf(stderr, "omnihil card: %s\n", problem.c_str());
  if (!cards.problems.empty()) return kExitBadInput;
  if (cards.cards.empty()) {
    std::fprintf(stderr,
                 "omnihil card: %s: has no *.card.json; `omnihil card MODEL --data DATASET` makes one\n",
                 a.gallery.c_str());
    return kExitBadInput;
  }
  replace_file(a.out, gallery_html(cards, a.out));
  fmt::print("{}: {} cards\n", a.out, cards.cards.size());
  return kExitOk;
}

void print_card(const ModelCard& card) {
  fmt::print("{}\n", card_sentence(card));
  for (const CardEffect& effect : card.effects) {
    for (const EffectEvidence& e : effect.evidence) {
      fmt::print("{} on {}: {}: {}\n", effect.name, e.dataset,
                 !e.tested ? "not tested"
                 : e.earns ? "earns its place"
                           : "earns no place",
                 e.why);
    }
  }
  for (const CardData& d : card.data) {
    fmt::print("{}: {}, licence {}\n", d.name, d.fingerprint, d.licence.empty() ? "not stated" : d.licence);
  }
}

int run(const Arguments& a) {
  if (!a.gallery.empty()) return gallery(a);
  if (a.model.empty() || a.data.empty())
    throw std::invalid_argument("allowed: MODEL --data DATASET…, or --gallery FOLDER --out FILE.html");
  CardRequest request;
  request.model = model_path(a.model);
  request.datasets = a.data;
  request.axes = axes_of(a.axes);
  request.evidence = !a.no_evidence;
  request.seed = a.seed;
  request.jobs = a.jobs;
  request.program = fmt::format("omnihil {} ({})", OMNIHIL_VERSION, program_commit());
  request.date = today_utc();
  StopSignals stop;
  CardOutcome made;
  {
    ProgressLine line;
    request.progress = [&](const Progress& p) {
      line.show(p.doing, p.share);
      return !StopSignals::requested();
    };
    made = make_card(request);
  }
  for (const ModelProblem& p : made.problems) std::fprintf(stderr, "omnihil card: %s\n", p.text().c_str());
  if (made.interrupted) return kExitInterrupted;
  if (!made.card) return kExitBadInput;
  fs::path folder = a.out;
  if (folder.empty()) folder = fs::exists(a.model) ? fs::path(a.model).parent_path() : fs::path();
  if (!folder.empty()) fs::create_directories(folder);
  const fs::path page = folder / (made.card->name + ".card.html"),
                 json = folder / (made.card->name + ".card.json");
  replace_file(page, card_html(*made.card));
  replace_file(json, card_json(*made.card));
  print_card(*made.card);
  fmt::print("{}, {} written\n", page.string(), json.string());
  return kExitOk;
}

}  // namespace

void add_verb_card(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand(
      "card", "a model's passport: numbers, evidence, error on unseen data, where it holds");
  verb.add_option("MODEL", a->model, "model file");
  verb.add_option("--data", a->data, "folders of measurements, or their dataset.toml").type_name("DATASET");
  verb.add_option(
      "--out", a->out,
      "folder for NAME.card.html and NAME.card.json (default: the model's); of --gallery the page");
  verb.add_option("--axes", a->axes,
                  "two axes of the map of validity, such as speed,abs_current (compare --json names them)");
  verb.add_flag("--no-evidence", a->no_evidence, "list the effects without testing each: no fits");
  verb.add_option("--gallery", a->gallery, "make a page of all cards in this folder").type_name("FOLDER");
  verb.add_option("--seed", a->seed, "of the simulated null and of the bootstrap").capture_default_str();
  verb.add_option("--jobs", a->jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.footer(
      "Cards that are there already are replaced. `omnihil models --check MODEL` says when the model was "
      "edited since.");
  verb.callback([a, &result] { result.exit_code = guarded("card", [&] { return run(*a); }); });
}

}  // namespace omnihil
