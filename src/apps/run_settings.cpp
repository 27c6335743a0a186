// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/run_settings.h"

#include <fmt/format.h>

#include "apps/open_recording.h"
#include "apps/system_setup.h"
#include "apps/usage.h"
#include "core/error.h"

namespace dxslam::apps {
namespace {

void refuse(bool unused, const char* option, const char* meant) {
  if (!unused) return;
  throw InputError(fmt::format("option {} has no use here, expected it {}", option, meant));
}

void check_map_settings(const RunSettings& settings, const SystemOptions& options) {
  if (options.mode == "localization" && settings.map_in.empty()) {
    throw InputError("mode localization has no map, expected --map-in FILE");
  }
  if (settings.autosave > 0 && settings.map_out.empty()) {
    throw InputError("--autosave has nowhere to save to, expected --map-out FILE");
  }
  if (settings.thumbnails && settings.map_out.empty()) {
    throw InputError("--thumbnails has no map to be put into, expected --map-out FILE");
  }
  const bool localizes = options.mode == "localization";
  refuse(settings.autosave > 0 && localizes, "--autosave", "with mode slam");
  refuse(settings.thumbnails && localizes, "--thumbnails", "with mode slam");
  refuse(!settings.vocabulary.empty() && !options.close_loops, "--vocabulary",
         "where loops are closed");
}

}  // namespace

void add_run_options(CLI::App& command, RunSettings& settings) {
  add_reader_options(command, settings.reader);
  command.add_option("--config", settings.config, "YAML file; see `dxslam config dump`");
  command.add_option("--features", settings.features, "extractor name or model manifest")
      ->check(extractor_name());
  command.add_option("--mode", settings.mode, "slam, or localization in the map of --map-in")
      ->check(one_of({"slam", "localization"}));
  command.add_option("--map-in", settings.map_in, "go on with this map");
  command.add_option("--map-out", settings.map_out, "save the map here");
  command
      .add_option("--autosave", settings.autosave,
                  "save it after every so many keyframes as well, not only at the end")
      ->check(whole_number(1));
  command.add_option("--vocabulary", settings.vocabulary,
                     "FBoW or DBoW2 file; none: loops by global descriptor alone");
  command.add_flag("--no-loop-closing", settings.no_loop_closing, "do not look for loops");
  command.add_option("--stride", settings.stride, "use every n-th frame")->check(whole_number(1));
  command.add_flag("--deterministic", settings.deterministic,
                   "one thread, exact arithmetic: the same result every time");
}

SystemOptions system_options_of(const RunSettings& settings) {
  SystemOptions options = load_system_options(
      {settings.config, settings.features, settings.mode, settings.deterministic});
  if (!settings.vocabulary.empty()) options.vocabulary = settings.vocabulary;
  if (settings.no_loop_closing) options.close_loops = false;
  check_map_settings(settings, options);
  return options;
}

}  // namespace dxslam::apps
