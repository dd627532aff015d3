// Each part of the installed libraries once; the exit code is the number of those that are not as expected.
#include <cstdio>

bool friction_slows_a_motor_by_its_formula();
bool a_packet_says_what_was_encoded();
bool a_swapped_sign_is_found();

int main() {
  const struct {
    const char* name;
    bool good;
  } parts[] = {{"models and effects", friction_slows_a_motor_by_its_formula()},
               {"protocols", a_packet_says_what_was_encoded()},
               {"identify", a_swapped_sign_is_found()}};
  int bad = 0;
  for (const auto& part : parts) {
    std::printf("%s: %s\n", part.name, part.good ? "as expected" : "NOT as expected");
    bad += part.good ? 0 : 1;
  }
  return bad;
}
