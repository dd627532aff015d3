// The picture of a field: what moved is in it, in well-formed XML.
#include "hil/field_view/field_picture.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "hil/field_view/seed_pictures.h"
#include "hil/field_view/seed_tour.h"
#include "hil/loop/reference_firmware.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {

SessionSetup setup_of() {
  SessionSetup setup;
  setup.model = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {0, 4};
  setup.opponent_ids = {4};
  setup.plant.physics = Physics::kPlanar;
  setup.field.contacts = true;
  setup.field.size = &kFieldDivisionB;
  setup.field.ball_m = {1.0, 0.0};
  return setup;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(FieldPicture, ShowsBothTeamsTheBallAndWhatHappened) {
  const SessionConfig config = session_config(setup_of());
  Session session(config, reference_firmware_for(config));
  FieldTrace trace(config);
  session.set_observer(&trace);
  session.put_ball({4.0, 0.0, 0.0215}, {4.0, 0.0, 0.0});
  session.set_pose(1, 0.0, 0.5, 0.0);
  session.set_pose(2, 0.16, 0.5, 0.0);
  session.set_velocity(1, 2.0, 0.0, 0.0);
  std::vector<std::uint8_t> out;
  for (int ms = 0; ms < 400; ++ms) session.step({}, out);
  EXPECT_EQ(trace.robots().size(), 3u);
  EXPECT_EQ(trace.robots().at(4).points.size(), 40u);
  EXPECT_TRUE(trace.robots().at(kOpponentKey + 4).opponent);
  const std::string svg = field_picture(trace, {.title = "a < b"});
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(count(svg, " 0 1 0 "), 6u);  // each robot at its start and its end
  EXPECT_EQ(count(svg, ">4</text>"), 2u);
  EXPECT_GE(count(svg, "goal at"), 1u);
  EXPECT_GE(count(svg, "robots meet"), 1u);
  EXPECT_EQ(count(svg, "<g>"), count(svg, "</g>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(FieldPicture, WithoutAFieldItIsAsLargeAsWhatMoved) {
  SessionSetup setup = setup_of();
  setup.field.size = nullptr;
  const SessionConfig config = session_config(setup);
  Session session(config, reference_firmware_for(config));
  FieldTrace trace(config);
  session.set_observer(&trace);
  std::vector<std::uint8_t> out;
  for (int ms = 0; ms < 50; ++ms) session.step({}, out);
  const std::string svg = field_picture(trace, {.title = "", .width_px = 270.0});
  // Robots from x = 0 to 2 m with 0.35 m around: 100 px to the metre.
  EXPECT_NE(svg.find("width=\"270\""), std::string::npos);
  EXPECT_EQ(svg.find("<rect x="), std::string::npos);
}

TEST(SeedTour, EverySystemGivesItsFigure) {
  const StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  const std::vector<TourRow> rows = seed_tour(*stored.model->robot);
  EXPECT_GE(rows.size(), 8u);
  for (const TourRow& row : rows) {
    EXPECT_FALSE(row.here.empty()) << row.system;
    EXPECT_EQ(row.here.find("nan"), std::string::npos) << row.text();
    EXPECT_EQ(row.here.find("inf"), std::string::npos) << row.text();
  }
}

TEST(SeedPictures, EachShowsWhatItIsCalled) {
  const StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  const std::vector<SeedPicture> pictures = seed_pictures(*stored.model->robot);
  EXPECT_EQ(pictures.size(), 9u);
  for (const SeedPicture& p : pictures) {
    EXPECT_NE(p.svg.find("</svg>"), std::string::npos) << p.name;
    EXPECT_NE(p.svg.find("<path"), std::string::npos) << p.name;
    EXPECT_EQ(p.svg.find("nan"), std::string::npos) << p.name;
    // The one in the manual is what the program draws.
    std::ifstream in(OMNIHIL_SOURCE_DIR "/docs/img/field_" + p.name + ".svg");
    const std::string kept{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(kept, p.svg) << "omnihil field seed --pictures DIR draws docs/img/field_" << p.name << ".svg";
  }
}

}  // namespace
}  // namespace omnihil
