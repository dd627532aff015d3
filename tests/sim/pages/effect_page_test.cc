// docs/effects holds what the program generates: `omnihil effects --docs docs/effects` after any change.
#include "sim/pages/effect_page.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/law/effect_registry.h"

namespace omnihil::test {
namespace {

std::string file_text(const std::string& name) {
  std::ifstream file(std::string(OMNIHIL_SOURCE_DIR) + "/docs/effects/" + name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(EffectPage, IsInTheDocumentationAsGenerated) {
  for (const EffectEntry* e : all_effects()) {
    const std::string id(e->info->id);
    EXPECT_EQ(file_text(id + ".md"), effect_page(*e)) << "write it by: omnihil effects --docs docs/effects";
    EXPECT_EQ(file_text("img/" + id + ".svg") == effect_picture(*e), true)
        << id << ".svg differs: omnihil effects --docs docs/effects";
  }
  EXPECT_EQ(file_text("index.md"), "# All effects\n\n" + effect_index());
}

TEST(EffectPage, HasAPictureWhoseTwoCurvesDiffer) {
  for (const EffectEntry* e : all_effects()) {
    const std::string svg = effect_picture(*e);
    if ((e->info->rigs & kOnAxis) == 0) continue;
    const std::size_t first = svg.find("points="), second = svg.find("points=", first + 1);
    ASSERT_NE(second, std::string::npos) << e->info->id;
    const auto points = [&](std::size_t at) { return svg.substr(at, svg.find("/>", at) - at); };
    EXPECT_NE(points(first), points(second)) << e->info->id << ": its picture does not show it";
  }
}

TEST(EffectPage, SaysWhatARigMustHaveForIt) {
  const auto says = [](const char* id, const char* text) {
    return effect_page(*find_effect(id)).find(text) != std::string::npos;
  };
  EXPECT_TRUE(says("duty_limit", "\n\nNeeds: a drive by duty.\n\n"));
  EXPECT_TRUE(says("stribeck_friction", "\n\nNeeds: nothing in particular.\n\n"));
  EXPECT_TRUE(says("cogging", "\n\nNeeds: on a robot: encoders.\n\n"));
  EXPECT_TRUE(says("shaft_compliance", "\n\nNeeds: an inertia on either side of the shaft.\n\n"));
  for (const EffectEntry* e : all_effects()) {
    const std::string_view path = e->info->excludes.path;
    EXPECT_EQ(says(std::string(e->info->id).c_str(), "Left out where the base model's `"), !path.empty());
  }
}

TEST(EffectPage, BelongsToAnEffectThatExists) {
  for (const auto& file :
       std::filesystem::directory_iterator(std::string(OMNIHIL_SOURCE_DIR) + "/docs/effects")) {
    const std::string stem = file.path().stem().string();
    if (file.is_directory() || stem == "README" || stem == "index") continue;
    EXPECT_NE(find_effect(stem), nullptr) << file.path().filename() << " is left over";
  }
}

}  // namespace
}  // namespace omnihil::test
