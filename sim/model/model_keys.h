// The list of all keys of a model file for people, as Markdown, from the rows themselves.
// docs/model-files.md carries it; a test holds the two together (`omnihil models --keys` prints it).
#pragma once
#include <string>

namespace omnihil {

std::string model_keys_markdown();

}  // namespace omnihil
