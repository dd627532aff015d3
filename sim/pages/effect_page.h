// What people read about one effect: a page in Markdown and a picture, both from its EffectInfo and a
// simulation.
//
//   folder.write("cogging.md", effect_page(*find_effect("cogging")));
//   folder.write("cogging.svg", effect_picture(*find_effect("cogging")));      // "" where no axis shows it
//
// `omnihil effects --docs DIR` writes them all; a test holds docs/effects to what is generated.
#pragma once
#include <string>

#include "sim/law/drive_params.h"
#include "sim/law/effect_entry.h"

namespace omnihil {

std::string effect_page(const EffectEntry& entry);
std::string effect_picture(const EffectEntry& entry);
// One line per effect, as a table.
std::string effect_index();

// The drive of the pictures: EC 45 flat 30 W by its data sheet, with a disc of 2e-5 kg m2, on 12 V.
DriveParams<double> demonstration_drive();

}  // namespace omnihil
