// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system_setup.h"

#include <fmt/format.h>

#include <filesystem>

#include "features/data_directory.h"
#include "features/extractor_factory.h"
#include "slam/loop_search.h"

namespace dxslam {

void settle_options(SystemOptions& options) {
  if (options.features == "auto") {
    const ExtractorChoice choice = choose_extractor();
    options.features = choice.name;
    options.features_note = choice.note;
  }
  options.extractor.deterministic = options.extractor.deterministic || options.deterministic;
  validate_system_options(options);
}

std::vector<std::string> feature_notes(const SystemOptions& options,
                                       const FeatureExtractor& extractor, bool in_stored_map) {
  std::vector<std::string> notes = extractor.notes();
  if (!options.features_note.empty()) notes.insert(notes.begin(), options.features_note);
  const bool finds_places = extractor.traits().global_dimension > 0;
  if (!finds_places) {
    notes.push_back(fmt::format(
        "features `{}` have no global descriptor: {}", extractor.name(),
        in_stored_map ? "no frame can be found in the stored map"
                      : "a place that was seen before is not found again when tracking is lost"));
  }
  const bool wants_words = options.close_loops && options.vocabulary == "auto";
  if (wants_words && find_vocabulary(options.vocabulary, extractor.name()).empty()) {
    notes.push_back(fmt::format(
        "no vocabulary of features `{}` was found in {}: {}", extractor.name(),
        (std::filesystem::path(data_directory()) / "models" / "vocabulary").string(),
        finds_places ? "loops are found by global descriptor alone" : "no loops are closed"));
  }
  return notes;
}

}  // namespace dxslam
