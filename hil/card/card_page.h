// The frame of a card's page and of the gallery: the style of the reports, a line of links, sections that fold.
//
//   std::string html = card_page("Model card", {{"errors", "Errors", "<p>…</p>"}}, "<h1>wheel 3</h1>");
//
// One file: no script, nothing from outside. Dark or light as the browser asks.
#pragma once
#include <string>
#include <vector>

namespace omnihil {

struct CardSection {
  std::string id;
  std::string title;
  std::string html;
};

// `title` is escaped here; `head`, above the sections, and their html are taken as they are.
std::string card_page(const std::string& title, const std::vector<CardSection>& sections,
                      const std::string& head);

}  // namespace omnihil
