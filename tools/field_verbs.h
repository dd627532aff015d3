// Verbs under `omnihil field`, a file each.
#pragma once
#include "tools/command_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {

void add_field_wheel(Verb& field, VerbResult& result);
void add_field_rectangle(Verb& field, VerbResult& result);
void add_field_pass(Verb& field, VerbResult& result);
void add_field_tyre(Verb& field, VerbResult& result);

}  // namespace omnihil
