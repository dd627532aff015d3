// The generated pages in docs/radio are what the tables give.
#include "protocols/emit/emit.h"

#include <sstream>

#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void expect_golden(const std::string& path, const std::string& text, const std::string& regenerate) {
  const auto want = lines_of(file_text(OMNIHIL_SOURCE_DIR + path));
  const auto have = lines_of(text);
  for (std::size_t i = 0; i < std::max(want.size(), have.size()); ++i) {
    const std::string a = i < want.size() ? want[i] : "(end)";
    const std::string b = i < have.size() ? have[i] : "(end)";
    ASSERT_EQ(a, b) << path << " line " << i + 1 << ". If the tables were meant to change: " << regenerate;
  }
}

TEST(Documentation, IsWhatTheTablesGive) {
  for (const RadioFormat* format : radio_formats()) {
    const std::string id(format->id);
    expect_golden("/docs/radio/" + id + ".md", emit_markdown(*format),
                  "./dev exec formats " + id + " > docs/radio/" + id + ".md");
  }
}

TEST(WiresharkDissector, IsWhatTheTablesGive) {
  for (const RadioFormat* format : radio_formats()) {
    const std::string id(format->id);
    expect_golden("/docs/radio/" + id + ".lua", emit_wireshark(*format),
                  "./dev exec formats " + id + " --wireshark > docs/radio/" + id + ".lua");
  }
}

TEST(DbcFile, OfTheExamplesIsWhatTheTablesGive) {
  expect_golden("/examples/can/odrive.dbc", emit_dbc(*find_radio_format("odrive-can")),
                "./dev exec formats odrive-can --dbc > examples/can/odrive.dbc");
  expect_golden("/examples/can/ibis-orion.dbc", emit_dbc(*find_radio_format("ibis-orion-can")),
                "./dev exec formats ibis-orion-can --dbc > examples/can/ibis-orion.dbc");
}

TEST(Documentation, NamesEveryPacketAndEveryFieldWithItsMeaning) {
  for (const RadioFormat* format : radio_formats()) {
    const std::string page = emit_markdown(*format);
    const std::string dissector = emit_wireshark(*format);
    for (const Message& message : format->messages) {
      EXPECT_NE(page.find("\n## " + std::string(message.name) + "\n"), std::string::npos) << message.name;
      EXPECT_NE(dissector.find("\"" + std::string(message.name) + "\""), std::string::npos) << message.name;
      for (const Field& field : message.fields) {
        EXPECT_NE(page.find("| `" + std::string(field.name) + "` | "), std::string::npos) << field.name;
        EXPECT_NE(page.find(field.what), std::string::npos) << field.name;
      }
    }
  }
}

}  // namespace
}  // namespace omnihil
