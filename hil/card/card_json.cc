#include <cmath>
#include <nlohmann/json.hpp>

#include "hil/card/model_card.h"
#include "hil/text/json_text.h"

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json numbers_json(const std::vector<CardNumber>& numbers) {
  Json out = Json::object();
  for (const CardNumber& n : numbers) {
    Json& at = out[n.path];
    if (n.values.empty()) {
      at["value"] = n.text;
    } else if (n.values.size() == 1) {
      at["value"] = number(n.values.front());
    } else {
      at["value"] = n.values;
    }
    if (!n.unit.empty()) at["unit"] = n.unit;
    at["kind"] = n.kind;
    if (n.interval) at["interval_95_percent"] = {number(n.interval->first), number(n.interval->second)};
    at["source"] = n.source.empty() ? Json(nullptr) : Json(n.source);
    if (!n.data.empty()) at["fitted_to"] = n.data;
    if (!n.date.empty()) at["fitted_on"] = n.date;
    at["what"] = n.what;
  }
  return out;
}

Json effects_json(const std::vector<CardEffect>& effects) {
  Json out = Json::array();
  for (const CardEffect& e : effects) {
    Json& at = out.emplace_back();
    at["effect"] = e.name;
    at["title"] = e.title;
    at["numbers"] = numbers_json(e.numbers);
    at["evidence"] = Json::array();
    for (const EffectEvidence& v : e.evidence) {
      Json& one = at["evidence"].emplace_back();
      one["dataset"] = v.dataset;
      one["tested"] = v.tested;
      one["earns_its_place"] = v.earns;
      one["why"] = v.why;
      if (!v.tested) continue;
      one["holdout_x_noise"] = {{"without", number(v.holdout_without)}, {"with", number(v.holdout_with)}};
      one["extrapolation_x_noise"] = {{"without", number(v.extrapolation_without)},
                                      {"with", number(v.extrapolation_with)}};
    }
  }
  return out;
}

Json errors_json(const Comparison& c) {
  Json out = Json::object();
  for (const SignalError& e : c.errors) {
    Json& at = out[std::string(split_name(e.split))][e.signal];
    at["unit"] = e.unit;
    at["samples"] = e.samples;
    at["rmse"] = number(e.rmse);
    at["percent_of_std"] = number(e.nrmse_percent);
    at["mean_absolute"] = number(e.mean_absolute);
    at["bias"] = number(e.bias);
    at["noise"] = number(e.noise_sigma);
    at["x_noise"] = number(e.in_sigmas);
  }
  return out;
}

Json map_json(const ValidityMap& map) {
  Json out;
  out["signal"] = map.signal;
  out["unit"] = map.unit;
  out["x"] = {{"axis", map.x.name}, {"unit", map.x.unit}, {"edges", map.x.edges}};
  out["y"] = {{"axis", map.y.name}, {"unit", map.y.unit}, {"edges", map.y.edges}};
  out["spread"] = number(map.spread);
  out["samples_outside"] = map.outside;
  Json fitted = Json::array(), unseen = Json::array(), rmse = Json::array(), bias = Json::array();
  for (const ValidityCell& cell : map.cells) {
    fitted.push_back(cell.fitted);
    unseen.push_back(cell.unseen);
    rmse.push_back(number(cell.rmse));
    bias.push_back(number(cell.bias));
  }
  out["samples_fitted"] = fitted;
  out["samples_unseen"] = unseen;
  out["rmse"] = rmse;
  out["bias"] = bias;
  return out;
}

Json data_json(const CardData& d) {
  Json out;
  out["name"] = d.name;
  out["title"] = d.title;
  out["fingerprint"] = d.fingerprint;
  out["fitted_to"] = d.fitted_to;
  out["licence"] = d.licence.empty() ? Json(nullptr) : Json(d.licence);
  out["source"] = d.source.empty() ? Json(nullptr) : Json(d.source);
  out["runs"] = Json::array();
  for (const CardRun& run : d.runs)
    out["runs"].push_back({{"file", run.file.name},
                           {"sha256", run.file.sha256},
                           {"use", std::string(split_name(run.use))},
                           {"duration_s", run.duration_s}});
  out["errors"] = errors_json(d.comparison);
  out["diverged"] = d.comparison.diverged;
  out["findings"] = Json::array();
  for (const DataFinding& f : d.findings) {
    const char* grade = f.grade == DataFinding::Grade::kFault   ? "fault"
                        : f.grade == DataFinding::Grade::kDoubt ? "doubt"
                                                                : "note";
    out["findings"].push_back({{"grade", grade}, {"kind", f.kind}, {"sentence", f.sentence}});
  }
  out["maps"] = Json::array();
  for (const ValidityMap& map : d.maps) out["maps"].push_back(map_json(map));
  return out;
}

}  // namespace

std::string card_json(const ModelCard& card) {
  Json out;
  out["format"] = "omnihil-card/1";
  out["name"] = card.name;
  out["title"] = card.title;
  out["rig"] = card.rig;
  out["source"] = card.source;
  out["sentence"] = card_sentence(card);
  out["program"] = card.program;
  out["date"] = card.date;
  out["files"] = Json::array();
  for (const HashedFile& file : card.files)
    out["files"].push_back({{"name", file.name}, {"sha256", file.sha256}});
  out["numbers"] = numbers_json(card.numbers);
  out["effects"] = effects_json(card.effects);
  out["data"] = Json::array();
  for (const CardData& d : card.data) out["data"].push_back(data_json(d));
  return json_text(out, 1) + "\n";
}

}  // namespace omnihil
