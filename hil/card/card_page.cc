#include "hil/card/card_page.h"

#include <fmt/format.h>

#include "hil/report/report_assets.h"
#include "hil/text/markup.h"

namespace omnihil {

std::string card_page(const std::string& title, const std::vector<CardSection>& sections,
                      const std::string& head) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n";
  html += fmt::format(
      "<title>{}</title>\n<style>\n{}\n</style>\n</head>\n<body>\n<nav aria-label=\"Sections\"><ul>\n",
      escaped(title), report_style());
  for (const CardSection& s : sections)
    html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", s.id, escaped(s.title));
  html += "</ul></nav>\n<main>\n" + head;
  for (const CardSection& s : sections) {
    html += fmt::format(
        "<section id=\"{}\">\n<details open><summary><h2>{}</h2></summary>\n{}</details>\n</section>\n", s.id,
        escaped(s.title), s.html);
  }
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace omnihil
