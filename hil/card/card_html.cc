#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/card/card_page.h"
#include "hil/card/model_card.h"
#include "hil/card/validity_picture.h"
#include "hil/report/report_text.h"

namespace omnihil {
namespace {

std::string value_cell(const CardNumber& n) {
  if (n.values.empty()) return escaped(n.text);
  std::string out;
  for (const double v : n.values) out += (out.empty() ? "" : ", ") + figure(v);
  return out;
}

std::string origin_cell(const CardNumber& n) {
  std::string out = escaped(n.source);
  if (n.kind == "fitted") {
    out = fmt::format("fitted{}{}{}", n.data.empty() ? "" : " to <code>" + escaped(n.data) + "</code>",
                      n.date.empty() ? "" : " on " + escaped(n.date),
                      n.source.empty() ? "" : "; believed before: " + escaped(n.source));
  } else if (n.source.empty() && n.kind != "default") {
    out = "<span class=\"mark\">not stated</span>";
  }
  return out;
}

std::string numbers_table(const std::vector<CardNumber>& numbers, const char* caption) {
  std::string html = fmt::format(
      "<table class=\"wide\"><caption>{}</caption>\n<thead><tr><th scope=\"col\">number</th><th "
      "scope=\"col\">value</th>"
      "<th scope=\"col\">unit</th><th scope=\"col\">95 % interval</th><th scope=\"col\">known</th><th "
      "scope=\"col\">source</th>"
      "</tr></thead><tbody>\n",
      caption);
  for (const CardNumber& n : numbers) {
    html += fmt::format(
        "<tr><th scope=\"row\"><code>{}</code> "
        "<small>{}</small></th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escaped(n.path), escaped(n.what), value_cell(n), escaped(n.unit),
        n.interval ? figure(n.interval->first) + " … " + figure(n.interval->second) : "–", escaped(n.kind),
        origin_cell(n));
  }
  return html + "</tbody></table>\n";
}

std::string numbers_section(const ModelCard& card) {
  std::vector<CardNumber> given, defaults;
  for (const CardNumber& n : card.numbers) (n.kind == "default" ? defaults : given).push_back(n);
  std::string html =
      "<p>\"Believed\" is a tolerance of the model's author, \"exact\" a number without one.</p>\n";
  html += numbers_table(given, "Numbers of the file");
  if (defaults.empty()) return html;
  return html +
         fmt::format(
             "<details><summary>{} numbers that the file leaves at their defaults</summary>\n{}</details>\n",
             defaults.size(), numbers_table(defaults, "Defaults"));
}

std::string effects_section(const ModelCard& card) {
  if (card.effects.empty()) return "<p>The model has no effect beyond its base equations.</p>\n";
  std::string html =
      "<p>Evidence: the model without the effect and with it, base parameters refitted on the fit runs in "
      "both; errors over "
      "the sensors' noise (1 is perfect) on runs that neither was fitted to.</p>\n";
  for (const CardEffect& e : card.effects) {
    html += fmt::format("<h3><code>{}</code> {}</h3>\n", escaped(e.name), escaped(e.title));
    html += numbers_table(e.numbers, "Its numbers");
    if (e.evidence.empty()) {
      html += "<p>Not tested on any data.</p>\n";
      continue;
    }
    html +=
        "<table><caption>What the data say</caption><thead><tr><th scope=\"col\">data</th><th "
        "scope=\"col\">verdict</th>"
        "<th scope=\"col\">holdout, without → with</th><th scope=\"col\">extrapolation, without → "
        "with</th><th scope=\"col\">why"
        "</th></tr></thead><tbody>\n";
    for (const EffectEvidence& v : e.evidence) {
      const auto change = [&](double from, double to) {
        return v.tested && std::isfinite(from)
                   ? fmt::format("{} → {} ({})", figure(from), figure(to), change_percent(from, to))
                   : std::string("–");
      };
      html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                          escaped(v.dataset),
                          !v.tested ? "not tested"
                          : v.earns ? "earns its place"
                                    : "earns no place",
                          change(v.holdout_without, v.holdout_with),
                          change(v.extrapolation_without, v.extrapolation_with), escaped(v.why));
    }
    html += "</tbody></table>\n";
  }
  return html;
}

std::string errors_section(const ModelCard& card) {
  std::string html =
      "<p>Of the model exactly as its file has it. Holdout: the same kind of motion. Extrapolation: another "
      "kind. Where the "
      "model was made by a search for effects, the holdout runs decided which effects stayed: its error is "
      "then a little too "
      "good.</p>\n<table><caption>Error per signal</caption><thead><tr><th scope=\"col\">data</th><th "
      "scope=\"col\">use</th>"
      "<th scope=\"col\">signal</th><th scope=\"col\">rms error</th><th scope=\"col\">unit</th><th "
      "scope=\"col\">% of std</th>"
      "<th scope=\"col\">bias</th><th scope=\"col\">noise</th><th scope=\"col\">× "
      "noise</th></tr></thead><tbody>\n";
  for (const CardData& d : card.data) {
    for (const Split split : {kValidation, kExtrapolation, kTraining}) {
      for (const SignalError& e : d.comparison.errors) {
        if (e.split != split) continue;
        html += fmt::format(
            "<tr><th "
            "scope=\"row\">{}</th><td>{}{}</td><td><code>{}</code></td><td>{}</td><td>{}</td><td>{}</"
            "td><td>{}</td><td>{}"
            "</td><td>{}</td></tr>\n",
            escaped(d.name), split_name(split), split == kTraining && d.fitted_to ? " (fitted to)" : "",
            escaped(e.signal), figure(e.rmse), escaped(e.unit), figure(e.nrmse_percent), figure(e.bias),
            figure(e.noise_sigma), figure(e.in_sigmas));
      }
    }
  }
  return html + "</tbody></table>\n";
}

std::string validity_section(const ModelCard& card) {
  std::string html =
      "<p>Numbers: rms error on runs that were not fitted to, in per cent of the signal's spread. Dashed: "
      "only fit runs were "
      "there. Dot: fewer than ten samples. Empty: no data; there the model is a guess.</p>\n";
  std::size_t shown = 0;
  for (const CardData& d : card.data) {
    for (const ValidityMap& map : d.maps) {
      html += fmt::format(
          "<figure><figcaption>{}: <code>{}</code><small>{}{}</small></figcaption>\n{}</figure>\n",
          escaped(d.name), escaped(map.signal), escaped(validity_sentence(map)),
          map.outside > 0
              ? fmt::format(" {} samples lie beyond the axes' ends (0.5 % quantiles).", map.outside)
              : "",
          validity_picture(map));
      ++shown;
    }
  }
  return shown > 0 ? html : "<p>No two axes vary in these data: there is no map.</p>\n";
}

std::string data_section(const ModelCard& card) {
  std::string html;
  for (const CardData& d : card.data) {
    html += fmt::format("<h3>{}</h3>\n<dl>\n", escaped(d.name));
    const auto row = [&html](const char* what, const std::string& text) {
      html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", what, text);
    };
    if (!d.title.empty()) row("title", escaped(d.title));
    row("fingerprint", "<code>" + escaped(d.fingerprint) + "</code>" +
                           (d.fitted_to ? ", numbers of this model were fitted to it" : ""));
    row("licence", d.licence.empty() ? "not stated in its README.md or LICENSE" : escaped(d.licence));
    row("source", d.source.empty() ? "not stated in its README.md" : escaped(d.source));
    html +=
        "</dl>\n<table><caption>Runs</caption><thead><tr><th scope=\"col\">file</th><th "
        "scope=\"col\">use</th><th "
        "scope=\"col\">s</th><th scope=\"col\">SHA-256</th></tr></thead><tbody>\n";
    for (const CardRun& run : d.runs) {
      html += fmt::format(
          "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
          escaped(run.file.name), split_name(run.use), figure(run.duration_s), escaped(run.file.sha256));
    }
    html += "</tbody></table>\n<ul class=\"findings\">\n";
    for (const DataFinding& f : d.findings) {
      const char* grade = f.grade == DataFinding::Grade::kFault   ? "fault"
                          : f.grade == DataFinding::Grade::kDoubt ? "doubt"
                                                                  : "note";
      html += fmt::format("<li class=\"{}\"><b>{}</b> {}</li>\n", grade, grade, escaped(f.sentence));
    }
    for (const std::string& note : d.notes)
      html += fmt::format("<li class=\"note\"><b>note</b> {}</li>\n", escaped(note));
    html += "</ul>\n";
    if (!d.readme.empty())
      html += fmt::format("<details><summary>Its README.md</summary><pre>{}</pre></details>\n",
                          escaped(d.readme));
  }
  return html;
}

std::string about_section(const ModelCard& card) {
  std::string html = "<dl>\n";
  const auto row = [&html](const char* what, const std::string& text) {
    if (!text.empty()) html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", what, text);
  };
  for (const HashedFile& file : card.files)
    row("file", escaped(file.name) + " <code>" + escaped(file.sha256) + "</code>");
  row("model's source", escaped(card.source));
  row("made", escaped(card.date + " by " + card.program));
  return html +
         "</dl>\n<p><code>omnihil models --check</code> says when one of these files was edited since.</p>\n";
}

}  // namespace

std::string card_sentence(const ModelCard& card) {
  // The strictest use that was measured, and in it the signal that is worst for its spread.
  for (const Split split : {kExtrapolation, kValidation}) {
    const SignalError* worst = nullptr;
    for (const CardData& d : card.data) {
      for (const SignalError& e : d.comparison.errors) {
        if (e.split != split || e.samples == 0) continue;
        if (worst == nullptr || e.nrmse_percent > worst->nrmse_percent) worst = &e;
      }
    }
    if (worst == nullptr) continue;
    return fmt::format(
        "On {} runs, which it was not fitted to, the worst signal is {}: off by {} {} ({} % of its spread).",
        split_name(split), worst->signal, figure(worst->rmse), worst->unit, figure(worst->nrmse_percent));
  }
  return "It was never held against data that it was not fitted to.";
}

std::string card_html(const ModelCard& card) {
  const std::string title = card.title.empty() ? card.name : card.title;
  std::string body = fmt::format(
      "<section class=\"verdict\" id=\"head\">\n<h1>{} ({}, <code>{}</code>)</h1>\n<p "
      "class=\"sentence\">{}</p>\n",
      escaped(title), escaped(card.rig), escaped(card.name), escaped(card_sentence(card)));
  body += "</section>\n";
  return card_page("Model card: " + title,
                   {{"errors", "Error on data it was not fitted to", errors_section(card)},
                    {"validity", "Where it was tested", validity_section(card)},
                    {"effects", "Effects and their evidence", effects_section(card)},
                    {"numbers", "Numbers", numbers_section(card)},
                    {"data", "Data", data_section(card)},
                    {"about", "What this card is true of", about_section(card)}},
                   body);
}

}  // namespace omnihil
