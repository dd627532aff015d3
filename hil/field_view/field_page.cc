#include "hil/field_view/field_page.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>
#include <stdexcept>

#include "hil/field_view/field_picture.h"
#include "hil/text/dataset_files.h"
#include "hil/text/markup.h"

extern char** environ;

namespace omnihil {
namespace {

std::string robot_name(const FieldTrace& trace, int index) {
  int n = 0;
  for (const auto& [key, robot] : trace.robots()) {
    if (n++ != index) continue;
    return fmt::format("{} {}", (trace.team() == Team::kBlue) != robot.opponent ? "blue" : "yellow",
                       robot.id);
  }
  return "a real one";
}

std::string row_of(const FieldTrace& trace, const WorldEvent& e) {
  const double time_s = 1e-9 * static_cast<double>(e.now_ns);
  std::string what;
  switch (e.kind) {
    case WorldEventKind::kKick:
      what = fmt::format("{} kicks at {:.2f} m/s", robot_name(trace, e.robot), e.size);
      break;
    case WorldEventKind::kGoal:
      what = fmt::format("goal on the {} side", e.robot > 0 ? "right" : "left");
      break;
    case WorldEventKind::kRobotsTouch:
      what = fmt::format("{} and {} meet", robot_name(trace, e.robot), robot_name(trace, e.other));
      break;
    case WorldEventKind::kBallTouch:
      what = fmt::format("the ball meets {}", robot_name(trace, e.robot));
      break;
    case WorldEventKind::kTip:
      what = fmt::format("{} tips over", robot_name(trace, e.robot));
      break;
  }
  return fmt::format("<tr><td>{:.3f}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n", time_s, what,
                     e.x_m, e.y_m);
}

// Runs rsvg-convert; false: there is none. Throws where it fails.
bool convert_to_png(const std::string& svg_file, const std::string& png_file) {
  std::string program = "rsvg-convert", out = "-o", to = png_file, from = svg_file;
  char* arguments[] = {program.data(), out.data(), to.data(), from.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawnp(&child, "rsvg-convert", nullptr, nullptr, arguments, environ) != 0) return false;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return false;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{}: rsvg-convert could not draw it", png_file));
  return true;
}

}  // namespace

std::string field_page(const FieldTrace& trace, const std::string& title) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>{0}</title>\n<style>\n"
      "body {{ font-family: sans-serif; max-width: 70rem; margin: 1rem auto; }}\n"
      "svg {{ max-width: 100%; height: auto; }}\n"
      "table {{ border-collapse: collapse; }}\ntd, th {{ padding: 0.1rem 0.8rem; text-align: left; }}\n"
      "</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      escaped(title));
  html += field_picture(trace, {});
  html += fmt::format("<h2>{} events</h2>\n", trace.events().size());
  html += "<table>\n<tr><th>s</th><th>what</th><th>x, m</th><th>y, m</th></tr>\n";
  for (const WorldEvent& event : trace.events()) html += row_of(trace, event);
  return html + "</table>\n</body>\n</html>\n";
}

void write_field_picture(const std::string& file, const FieldTrace& trace, const std::string& title) {
  if (file.ends_with(".svg")) return write_new_file(file, field_picture(trace, {.title = title}));
  if (file.ends_with(".html")) return write_new_file(file, field_page(trace, title));
  if (!file.ends_with(".png"))
    throw std::invalid_argument(fmt::format("{}: allowed: a file that ends in .svg, .png or .html", file));
  const std::string beside = file + ".svg";
  if (std::filesystem::exists(file)) throw std::runtime_error(file + ": is there already");
  write_new_file(beside, field_picture(trace, {.title = title}));
  bool drawn = false;
  try {
    drawn = convert_to_png(beside, file);
  } catch (...) {
    std::filesystem::remove(beside);
    throw;
  }
  std::filesystem::remove(beside);
  if (!drawn)
    throw std::runtime_error(fmt::format(
        "{}: PNG needs rsvg-convert (apt install librsvg2-bin); .svg and .html need nothing", file));
}

}  // namespace omnihil
