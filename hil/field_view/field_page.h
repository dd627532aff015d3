// A field from above as a file: SVG, PNG, or a page with a table of what happened.
//
//   write_field_picture("match.png", trace, "match.omnirec");
//
// The ending says which: .svg, .png, .html. A PNG is drawn by rsvg-convert (Debian's librsvg2-bin); where it is not
// installed the error says so.
#pragma once
#include <string>

#include "hil/loop/field_trace.h"

namespace omnihil {

// Self-contained: no scripts, nothing from elsewhere.
std::string field_page(const FieldTrace& trace, const std::string& title);

// Throws std::invalid_argument for another ending, std::runtime_error where a PNG cannot be drawn, std::system_error
// where the file cannot be written; refuses to replace one.
void write_field_picture(const std::string& file, const FieldTrace& trace, const std::string& title);

}  // namespace omnihil
