#include "tools/options/field_options.h"

#include <sstream>

namespace omnihil {

void add_field_options(Verb& verb, FieldWords& w) {
  verb.add_option(
          "--field", w.size,
          "boards and goals of this field, and vision's geometry (default: an open floor; vision tells of "
          "division-b)")
      .one_of({"division-a", "division-b", "seed-paper"});
  verb.add_option(
      "--ball", w.ball,
      "X,Y in m where a ball lies at the start (default: none until the league's control puts one)");
  verb.add_option("--opponents", w.opponents, "ids of the other team's robots, of the same model: 0-5");
  verb.add_option(
          "--spread", w.spread,
          "each robot's numbers drawn about the model's, in its tolerances: 1 as they are said; from --seed")
      .range(0.0, 10.0);
  verb.add_flag("--ghosts", w.ghosts, "robots pass through each other and have no kicker, dribbler and beam");
}

void understand_field(const FieldWords& words, SessionSetup& setup, std::vector<std::string>& problems) {
  setup.spread = words.spread;
  setup.field.contacts = !words.ghosts;
  if (!words.size.empty()) setup.field.size = find_field(words.size);
  if (!words.opponents.empty()) setup.opponent_ids = parse_robot_list(words.opponents, problems);
  if (words.ghosts && (!words.size.empty() || !words.ball.empty()))
    problems.push_back("--ghosts: touches nothing, neither boards (--field) nor a ball (--ball)");
  if (words.ball.empty()) return;
  std::istringstream in(words.ball);
  double x_m = 0.0, y_m = 0.0;
  char comma = 0;
  if (in >> x_m >> comma >> y_m && comma == ',' && in.peek() == std::istringstream::traits_type::eof())
    setup.field.ball_m = {x_m, y_m};
  else
    problems.push_back("--ball: found \"" + words.ball + "\", allowed: X,Y in m such as 0.5,0");
}

}  // namespace omnihil
