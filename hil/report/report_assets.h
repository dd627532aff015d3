// What is built into the program for its HTML reports (web/, bundled by cmake/report_assets.cmake).
#pragma once
#include <string_view>

namespace omnihil {

std::string_view report_style();   // web/report/report.css
std::string_view report_script();  // web/report/*.js
std::string_view uplot_script();   // uPlot; empty when it could not be had
std::string_view uplot_style();
std::string_view uplot_licence();
std::string_view uplot_missing();  // why it is empty

}  // namespace omnihil
