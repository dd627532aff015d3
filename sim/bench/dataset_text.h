// The text of a measurement in the format "omnihil-dataset/1", whatever wrote its columns.
//
//   std::string text = dataset_head("simulated: ulaval_alpha", "robot");
//   text += channel_line("motor_current_1", "current_1", 0.03) + channel_line("encoder_1", "ticks_1", 0.0, ", counts_per_rev = 4096");
//   text += run_lines("steps.csv", "fit", "steps of the duty");
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

// Of a dataset whose model is model.toml and whose time is the column time_s: up to its further [channels]. `radio`: the format
// that its commands were sent in; empty: none.
std::string dataset_head(std::string_view title, std::string_view rig, std::string_view radio = "");
// `more`: further keys. sigma: 0: not stated.
std::string channel_line(std::string_view signal, std::string_view column, double sigma = 0.0,
                         std::string_view more = "");
// A column of a virtual bench's runs: its line in [channels], and how its numbers are written.
struct BenchColumn {
  std::string signal, column;
  const char* format = "{:.9g}";  // of fmt
  double sigma = 0.0;             // white noise of its sensor; 0: none
  std::string more = {};          // further keys of its line: ", counts_per_rev = 4096"
  std::string stream = {};        // of its noise
};
// Head and [channels] of a dataset of them; runs follow.
std::string columns_text(std::string_view title, std::string_view rig,
                         const std::vector<BenchColumn>& columns);
std::string bench_header(const std::vector<BenchColumn>& columns);  // first line of a run's CSV
// A value a column, NaN: an empty cell. With a seed, their sensors' noise is put on row `k`'s.
std::string bench_line(const std::vector<BenchColumn>& columns, double time_s,
                       const std::vector<double>& values, std::optional<std::uint64_t> seed = {},
                       std::uint64_t k = 0);

// An empty excitation is not written.
std::string run_lines(std::string_view file, std::string_view use, std::string_view excitation = "");

}  // namespace omnihil
