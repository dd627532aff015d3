// Cards that lie in a folder: read back, listed on one page, held against the model files that they describe.
//
//   CardFolder cards = read_cards("models");                 // *.card.json there and one folder below
//   std::string html = gallery_html(cards, "gallery.html");
//   for (const std::string& line : stale_card_notes("bench/model.toml")) std::puts(line.c_str());
//
// A card is stale when a file that it names has other bytes now, or is gone. Cannot: find a card that was moved away
// from its model.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "hil/text/hashed_file.h"

namespace omnihil {

struct StoredCard {
  std::filesystem::path json;  // the file
  std::string name, title, rig, sentence, date;
  std::vector<HashedFile> files;
  std::vector<std::string> effects,
      datasets;  // effects that were tested and earn no place: "cogging (earns no place)"
};

struct CardFolder {
  std::vector<StoredCard> cards;      // by path
  std::vector<std::string> problems;  // a line each: files that are no cards
};

CardFolder read_cards(const std::filesystem::path& folder);

// "model.toml was edited since its card model.card.json was made on 2026-11-23 (sha256 0123456789ab, then 9f86d081884c)".
// Empty: no card beside this model, or all as it was.
std::vector<std::string> stale_card_notes(const std::filesystem::path& model_file);

// Links are relative to `page`'s folder.
std::string gallery_html(const CardFolder& cards, const std::filesystem::path& page);

}  // namespace omnihil
