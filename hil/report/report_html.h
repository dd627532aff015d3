// A diagnosis as one HTML file that needs nothing else: charts, tables, text; no network, no script from
// outside.
//
//   ReportInput in = report_input(dataset, *predictor, diagnosis, {.jobs = 2});
//   in.model = "bench/wheel3/model.toml";  in.command = "omnihil diagnose bench/wheel3";
//   std::string html = report_html(in);              // under 3 MB whatever the dataset's length
//
// All that comes from outside (names of datasets, runs, signals, notes) is escaped. Overlays are thinned to
// the least and the greatest value per interval, so that a peak stays a peak; how far is written below each
// chart. Cannot: show a recording sample by sample once it is longer than what fits (at least 200 intervals
// per run).
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "identify/select/diagnosis.h"

namespace omnihil {

// One signal of one run: measured, and what the two models say. NaN: not there.
struct ReportOverlay {
  std::string run;
  Split split = Split::kTraining;
  std::string signal;
  std::string unit;
  double noise_sigma = 0.0;
  std::vector<double> time_s;
  std::vector<double> measured;
  std::vector<double> baseline;     // nominal model, base parameters refitted
  std::vector<double> final_model;  // with the effects found
};

// Amplitude of the residual per order (periods per turn of an angle) before and after the effects were added.
struct OrderSpectrum {
  std::string signal;
  std::string unit;
  std::string angle;             // "rotor_angle", "output_angle"
  std::vector<double> order;     // 1, 2, …
  std::vector<double> baseline;  // amplitude in `unit`
  std::vector<double> final_model;
  double floor = 0.0;  // what chance alone would show, of the final residual
};

struct ReportInput {
  Diagnosis diagnosis;
  std::string title;    // of the dataset
  std::string model;    // the nominal model's file
  std::string command;  // that made the report
  std::string program;  // name, version, commit
  double elapsed_s = 0.0;
  std::vector<std::string> notes;  // of the dataset: what was left out
  std::vector<ReportOverlay> overlays;
  std::vector<OrderSpectrum> spectra;
};

struct ReportOptions {
  int jobs = 1;
};

// Runs the baseline and the final model of the diagnosis over every run. The same at any number of threads.
ReportInput report_input(const Dataset& dataset, const Predictor& predictor, const Diagnosis& diagnosis,
                         const ReportOptions& options);

std::string report_html(const ReportInput& input);

}  // namespace omnihil
