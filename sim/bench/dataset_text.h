// The text of a measurement in the format "omnihil-dataset/1", whatever wrote its columns.
//
//   std::string text = dataset_head("simulated: ulaval_alpha", "robot");
//   text += channel_line("motor_current_1", "current_1", 0.03) + channel_line("encoder_1", "ticks_1", 0.0, ", counts_per_rev = 4096");
//   text += run_lines("steps.csv", "fit", "steps of the duty");
#pragma once
#include <string>
#include <string_view>

namespace omnihil {

// Of a dataset whose model is model.toml and whose time is the column time_s: up to its further [channels]. `radio`: the format
// that its commands were sent in; empty: none.
std::string dataset_head(std::string_view title, std::string_view rig, std::string_view radio = "");
// `more`: further keys. sigma: 0: not stated.
std::string channel_line(std::string_view signal, std::string_view column, double sigma = 0.0,
                         std::string_view more = "");
// An empty excitation is not written.
std::string run_lines(std::string_view file, std::string_view use, std::string_view excitation = "");

}  // namespace omnihil
