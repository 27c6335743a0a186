// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/system_setup.h"

#include "apps/console.h"
#include "features/extractor_factory.h"
#include "io/formats/options_yaml.h"

namespace dxslam::apps {

SystemOptions load_system_options(const SystemArguments& arguments) {
  SystemOptions options;
  if (!arguments.config.empty()) options = load_options(arguments.config, options);
  if (!arguments.features.empty()) options.features = arguments.features;
  if (options.features == "auto") {
    const ExtractorChoice choice = choose_extractor();
    options.features = choice.name;
    options.features_note = choice.note;
  }
  if (!arguments.mode.empty()) options.mode = arguments.mode;
  options.deterministic = options.deterministic || arguments.deterministic;
  options.extractor.deterministic = options.extractor.deterministic || options.deterministic;
  validate_system_options(options);
  return options;
}

std::vector<std::string> feature_notes(const SystemOptions& options,
                                       const FeatureExtractor& extractor) {
  std::vector<std::string> notes = extractor.notes();
  if (!options.features_note.empty()) notes.insert(notes.begin(), options.features_note);
  return notes;
}

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) warn_text("note: " + note);
}

}  // namespace dxslam::apps
