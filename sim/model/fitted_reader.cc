#include "sim/model/fitted_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/law/spelling.h"

namespace omnihil {
namespace {

constexpr std::string_view kFitKeys[] = {"sigma", "data", "date", "believed"};

class FittedReader {
 public:
  FittedReader(const ModelDocument& document, const std::string& path, const BeliefRule& rule,
               std::vector<ModelProblem>& problems)
      : document_(document), path_(path), rule_(rule), problems_(problems) {}

  void read(const toml::table& number, NumberBelief& belief) {
    const toml::node* source = number.get("source");
    if (source == nullptr || source->value_or(std::string()) != kFittedSource) {
      const toml::node& at = source != nullptr ? *source : static_cast<const toml::node&>(number);
      wrong(at, path_ + ".source", "sigma, data, date and believed are of a fit",
            "allowed beside them: source = \"fitted\"");
    }
    if (const toml::node* tolerance = number.get("tolerance")) {
      wrong(*tolerance, path_ + ".tolerance", "stands beside a fit",
            "the tolerance of a fitted number stands in its believed = { value = …, tolerance = … }");
    }
    belief.note.source.clear();
    FittedNumber& fitted = belief.note.fitted.emplace();
    if (const toml::node* sigma = number.get("sigma")) fitted.sigma = not_negative(*sigma, path_ + ".sigma");
    if (const toml::node* data = number.get("data")) fitted.data = text(*data, path_ + ".data");
    if (const toml::node* date = number.get("date")) fitted.date = text(*date, path_ + ".date");
    if (const toml::node* believed = number.get("believed")) read_believed(*believed, belief, fitted);
  }

 private:
  void wrong(const toml::node& node, const std::string& key, std::string what, std::string allowed) {
    problems_.push_back(problem_at(document_, node.source(), key, document_.written(node), std::move(what),
                                   std::move(allowed)));
  }

  std::optional<double> not_negative(const toml::node& node, const std::string& key) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (number && std::isfinite(*number) && *number >= 0.0) return number;
    wrong(node, key, "is not usable", "a number of 0 or more is needed (1-sigma, in the number's unit)");
    return std::nullopt;
  }

  std::string text(const toml::node& node, const std::string& key) {
    if (!node.is_string()) wrong(node, key, fmt::format("is {}", kind_of(node)), "a text is needed");
    return node.value_or(std::string());
  }

  void read_believed(const toml::node& node, NumberBelief& belief, FittedNumber& fitted) {
    const std::string path = path_ + ".believed";
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      return wrong(node, path, fmt::format("is {}", kind_of(node)),
                   "write { value = …, tolerance = …, source = \"…\" }");
    }
    for (const auto& [key, part] : *table) {
      const std::string name(key.str()), full = path + "." + name;
      if (name == "value") {
        read_believed_value(part, full, fitted);
      } else if (name == "tolerance") {
        read_tolerance(part, full, belief);
      } else if (name == "sigma" && rule_.absolute_sigma) {
        fitted.believed_sigma = not_negative(part, full);
      } else if (name == "source") {
        belief.note.source = text(part, full);
      } else {
        problems_.push_back(problem_at(document_, key.source(), full, "", "unknown key of a belief", keys()));
      }
    }
    if (table->get("value") == nullptr)
      wrong(node, path, "has no value", "write { value = …, tolerance = … }");
    if (table->get("tolerance") == nullptr && !(rule_.absolute_sigma && table->get("sigma") != nullptr))
      wrong(node, path, "has no tolerance", "what is known exactly is not fitted");
  }

  void read_believed_value(const toml::node& node, const std::string& key, FittedNumber& fitted) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (number && std::isfinite(*number) && rule_.within(*number)) {
      fitted.believed = number;
    } else {
      wrong(node, key, node.is_number() ? "is out of range" : fmt::format("is {}", kind_of(node)),
            "allowed: " + rule_.range);
    }
  }

  void read_tolerance(const toml::node& node, const std::string& key, NumberBelief& belief) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (number && *number >= 0.0 && *number <= kLargestTolerance) {
      belief.tolerance = number;
    } else {
      wrong(node, key, "is not usable",
            fmt::format("allowed: 0 to {:g}, relative to the value (1-sigma)", kLargestTolerance));
    }
  }

  std::string keys() const {
    return rule_.absolute_sigma ? "allowed: value, tolerance, sigma, source"
                                : "allowed: value, tolerance, source";
  }

  const ModelDocument& document_;
  const std::string& path_;
  const BeliefRule& rule_;
  std::vector<ModelProblem>& problems_;
};

}  // namespace

bool is_fit_key(std::string_view key) {
  return std::find(std::begin(kFitKeys), std::end(kFitKeys), key) != std::end(kFitKeys);
}

bool has_fit_key(const toml::table& number) {
  return std::any_of(std::begin(kFitKeys), std::end(kFitKeys),
                     [&](std::string_view key) { return number.contains(key); });
}

void read_fitted(const ModelDocument& document, const std::string& path, const toml::table& number,
                 const BeliefRule& rule, NumberBelief& belief, std::vector<ModelProblem>& problems) {
  if (has_fit_key(number)) FittedReader(document, path, rule, problems).read(number, belief);
}

}  // namespace omnihil
