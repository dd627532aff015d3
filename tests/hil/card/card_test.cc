// A model's card: what stands in it is what the files and the comparison say.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hil/card/card_gallery.h"
#include "hil/card/model_card.h"
#include "hil/card/provenance.h"
#include "hil/dataset/dataset_fingerprint.h"
#include "hil/dataset/dataset_reader.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

fs::path sound_drive() { return fs::path(OMNIHIL_SOURCE_DIR) / "tests/data/broken/sound_drive"; }

// A folder of its own for each test, with a copy of a sound measurement.
class Cards : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / (std::string("omnihil-card-") +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy(sound_drive(), folder_ / "bench", fs::copy_options::recursive);
    model_ = folder_ / "bench/model.toml";
  }
  void TearDown() override { fs::remove_all(folder_); }

  CardRequest request() const {
    CardRequest r;
    r.model = model_.string();
    r.datasets = {(folder_ / "bench").string()};
    r.evidence = false;
    r.program = "omnihil";
    r.date = "2026-11-23";
    return r;
  }
  ModelCard card() const {
    const CardOutcome made = make_card(request());
    for (const ModelProblem& p : made.problems) ADD_FAILURE() << p.text();
    return made.card.value_or(ModelCard{});
  }
  void write(const fs::path& path, const std::string& text) const {
    std::ofstream(path, std::ios::binary) << text;
  }
  std::string model_text() const {
    std::ifstream in(model_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static const CardNumber* number(const std::vector<CardNumber>& all, const std::string& path) {
    for (const CardNumber& n : all) {
      if (n.path == path) return &n;
    }
    return nullptr;
  }

  fs::path folder_, model_;
};

TEST_F(Cards, ErrorsAreThoseOfTheComparisonOfTheFileAsItIs) {
  const DatasetReading reading = read_dataset((folder_ / "bench").string());
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const Comparison expected = compare(*predictor, *reading.nominal);
  const ModelCard made = card();
  ASSERT_EQ(made.data.size(), 1u);
  ASSERT_EQ(made.data[0].comparison.errors.size(), expected.errors.size());
  for (const SignalError& e : expected.errors)
    EXPECT_EQ(made.data[0].comparison.error(e.split, e.signal)->rmse, e.rmse) << e.signal;
  EXPECT_EQ(made.data[0].fingerprint, dataset_fingerprint((folder_ / "bench").string(), *reading.dataset));
}

TEST_F(Cards, AnIntervalIs196ToleranceAboutTheValue) {
  const DatasetReading reading = read_dataset((folder_ / "bench").string());
  const Parameter* r = reading.nominal->file.parameters.find("motor.resistance_ohm");
  ASSERT_TRUE(r != nullptr && r->tolerance);
  const ModelCard made = card();
  const CardNumber* n = number(made.numbers, "motor.resistance_ohm");
  ASSERT_TRUE(n != nullptr && n->interval);
  EXPECT_EQ(n->kind, "believed");
  EXPECT_EQ(n->unit, "ohm");
  EXPECT_DOUBLE_EQ(n->interval->first, r->value() - 1.96 * *r->tolerance * r->value());
  EXPECT_DOUBLE_EQ(n->interval->second, r->value() + 1.96 * *r->tolerance * r->value());
}

TEST_F(Cards, AFittedNumberSaysToWhatAndWhen) {
  std::string text = model_text();
  const std::size_t at = text.find("resistance_ohm");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, text.find('\n', at) - at,
               "resistance_ohm = { value = 0.47, sigma = 0.01, source = \"fitted\", data = "
               "\"sha256:0123456789ab\", date = "
               "\"2026-11-01\", believed = { value = 0.464, tolerance = 0.1, source = \"data sheet\" } }");
  write(model_, text);
  const ModelCard made = card();
  const CardNumber* n = number(made.numbers, "motor.resistance_ohm");
  ASSERT_TRUE(n != nullptr && n->interval);
  EXPECT_EQ(n->kind, "fitted");
  EXPECT_EQ(n->data, "sha256:0123456789ab");
  EXPECT_EQ(n->date, "2026-11-01");
  EXPECT_EQ(n->source, "data sheet");
  EXPECT_DOUBLE_EQ(n->interval->first, 0.47 - 1.96 * 0.01);
}

TEST_F(Cards, AnEffectThatTheDataHaveEarnsItsPlaceAndOneThatTheyLackDoesNot) {
  // The measurement was made with Coulomb friction and without cogging.
  std::string text = model_text();
  write(model_, text +
                    "\n[effects.cogging]\namplitude_Nm = { value = 1e-4, tolerance = 1.0, source = \"guess\" "
                    "}\norder = 48\n");
  CardRequest asked = request();
  asked.evidence = true;
  const CardOutcome made = make_card(asked);
  for (const ModelProblem& p : made.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(made.card);
  bool seen = false;
  for (const CardEffect& e : made.card->effects) {
    ASSERT_EQ(e.evidence.size(), 1u) << e.name;
    EXPECT_FALSE(e.evidence[0].why.empty()) << e.name;
    if (e.name == "coulomb_friction") {
      EXPECT_TRUE(e.evidence[0].earns) << e.evidence[0].why;
      EXPECT_LT(e.evidence[0].holdout_with, e.evidence[0].holdout_without);
    }
    if (e.name != "cogging") continue;
    seen = true;
    EXPECT_TRUE(e.evidence[0].tested);
    EXPECT_FALSE(e.evidence[0].earns) << e.evidence[0].why;
    EXPECT_EQ(number(e.numbers, "cogging.amplitude_Nm")->source, "guess");
  }
  EXPECT_TRUE(seen);
}

TEST_F(Cards, LicenceAndSourceComeFromTheReadme) {
  write(folder_ / "bench/README.md", "# Bench\n\n- Source: our bench, 2026. Licence: MIT.\n- Rig: an axis\n");
  const ModelCard made = card();
  EXPECT_EQ(made.data[0].licence, "MIT.");
  EXPECT_EQ(made.data[0].source, "our bench, 2026.");
  EXPECT_NE(card_html(made).find("our bench, 2026."), std::string::npos);
  EXPECT_EQ(stated_in("no word of it", "licence"), "");
}

TEST_F(Cards, WhatIsNotStatedIsSaid) {
  const std::string html = card_html(card());
  EXPECT_NE(html.find("not stated in its README.md"), std::string::npos);
}

TEST_F(Cards, TextFromFilesIsEscapedInThePage) {
  write(folder_ / "bench/README.md", "Licence: <script>alert(1)</script>\n");
  EXPECT_EQ(card_html(card()).find("<script"), std::string::npos);
}

TEST_F(Cards, JsonHoldsTheSame) {
  const ModelCard made = card();
  const nlohmann::json j = nlohmann::json::parse(card_json(made));
  EXPECT_EQ(j["format"], "omnihil-card/1");
  EXPECT_EQ(j["data"][0]["fingerprint"], made.data[0].fingerprint);
  EXPECT_EQ(j["data"][0]["runs"].size(), 2u);
  EXPECT_EQ(j["data"][0]["runs"][0]["sha256"].get<std::string>().size(), 64u);
  for (const SignalError& e : made.data[0].comparison.errors) {
    EXPECT_DOUBLE_EQ(j["data"][0]["errors"][std::string(split_name(e.split))][e.signal]["rmse"].get<double>(),
                     e.rmse);
  }
  ASSERT_FALSE(j["data"][0]["maps"].empty());
  const auto& map = j["data"][0]["maps"][0];
  EXPECT_EQ(map["rmse"].size(), (map["x"]["edges"].size() - 1) * (map["y"]["edges"].size() - 1));
}

TEST_F(Cards, AnEditedModelMakesItsCardStale) {
  write(folder_ / "bench/model.card.json", card_json(card()));
  EXPECT_TRUE(stale_card_notes(model_).empty());
  write(model_, model_text() + "# another thought\n");
  const auto notes = stale_card_notes(model_);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("was edited since its card model.card.json was made on 2026-11-23"),
            std::string::npos)
      << notes[0];
}

TEST_F(Cards, ACardOfAnotherModelIsNotItsCard) {
  write(folder_ / "bench/model.card.json", card_json(card()));
  fs::copy_file(model_, folder_ / "bench/other.toml");
  EXPECT_TRUE(stale_card_notes(folder_ / "bench/other.toml").empty());
}

TEST_F(Cards, AGalleryListsCardsAndMarksStaleOnes) {
  const ModelCard made = card();
  write(folder_ / "bench/model.card.json", card_json(made));
  write(folder_ / "bench/model.card.html", card_html(made));
  const CardFolder found = read_cards(folder_);
  EXPECT_TRUE(found.problems.empty());
  ASSERT_EQ(found.cards.size(), 1u);
  EXPECT_EQ(found.cards[0].sentence, card_sentence(made));
  const std::string page = gallery_html(found, folder_ / "gallery.html");
  EXPECT_NE(page.find("href=\"bench/model.card.html\""), std::string::npos);
  EXPECT_EQ(page.find("was edited since"), std::string::npos);
  write(model_, model_text() + "# edited\n");
  EXPECT_NE(gallery_html(found, folder_ / "gallery.html").find("was edited since"), std::string::npos);
}

TEST_F(Cards, WhatIsNoCardIsNamed) {
  write(folder_ / "a.card.json", "not json");
  write(folder_ / "b.card.json", "{\"format\": \"omnihil-card/9\"}");
  write(folder_ / "c.card.json", "{\"format\": \"omnihil-card/1\", \"files\": []}");
  const CardFolder found = read_cards(folder_);
  EXPECT_TRUE(found.cards.empty());
  ASSERT_EQ(found.problems.size(), 3u);
  EXPECT_NE(found.problems[0].find("is no JSON object"), std::string::npos) << found.problems[0];
  EXPECT_NE(found.problems[1].find("omnihil-card/9"), std::string::npos) << found.problems[1];
  EXPECT_NE(found.problems[2].find("files is empty"), std::string::npos) << found.problems[2];
}

}  // namespace
}  // namespace omnihil
