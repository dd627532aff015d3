// Reads a measurement folder (format "omnihil-dataset/1") and its nominal model, whole, or says all that is
// wrong with it.
//
//   DatasetReading r = read_dataset("bench/wheel3");            // a folder or its dataset.toml
//   for (const ModelProblem& p : r.problems) std::cerr << p.text() << "\n";
//   if (r.dataset) diagnose(*r.dataset, *r.nominal, {});
//
// Refused with file, line, column (of a CSV: row and name of the column), what was found and what is allowed:
// an unknown channel, unit or key, time going backwards, a cell that is no number, a file without rows, no
// fit run, no drive input, no motion signal. Nothing is dropped silently: what is left out is counted in
// Dataset::notes. A file of a run lies inside the dataset's folder. Where a run has two drive inputs, the one
// listed first in [channels] is taken and the other left out.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "identify/predict/candidate.h"
#include "identify/record/dataset.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct DatasetReading {
  std::optional<Dataset> dataset;  // both or none
  std::optional<Candidate> nominal;
  std::string model_text;  // of the nominal model, as read
  std::vector<ModelProblem> problems;
};

// What a robot under commands is predicted with, in place of what the dataset names; empty: as it does.
struct OtherFirmware {
  std::string file{}, board{};
  std::string format{};  // file of the radio format that the board names (docs/radio/own-format.md)
};

// `model`: path of another model to take in place of the dataset's own; empty: its own.
DatasetReading read_dataset(const std::string& path, const std::string& model = "",
                            const OtherFirmware& firmware = {});

// A model for a dataset, alone.
struct CandidateReading {
  std::optional<Candidate> candidate;
  std::string text;
  std::vector<ModelProblem> problems;
};
CandidateReading read_candidate(const std::string& model_path);

}  // namespace omnihil
