// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <cerrno>
#include <cstring>
#include <exception>
#include <sstream>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/failure.h"
#include "apps/process.h"
#include "apps/usage.h"

namespace dxslam::apps {
namespace {

void add_commands(CLI::App& app) {
  app.set_help_flag("-h,--help", "print this help and end");  // of the commands as well
  app.set_version_flag("--version", "dxslam " DXSLAM_VERSION, "print the version and end");
  app.require_subcommand(1);
  add_run_command(app);
  add_lifelong_command(app);
  add_info_command(app);
  add_record_command(app);
  add_eval_command(app);
  add_synth_command(app);
  add_config_command(app);
  add_features_command(app);
  add_vocab_command(app);
  add_loops_command(app);
  add_map_command(app);
  add_relocalize_command(app);
}

// Help, or what is wrong with the command line.
int say_usage(const CLI::App& app, int argc, const char* const* argv,
              const CLI::ParseError& error) {
  std::ostringstream out;
  std::ostringstream unused;
  const int code = app.exit(error, out, unused);
  print_text(out.str());
  if (code == 0) return kSuccess;
  warn("{}", usage_problem(app, argc, argv, error));
  return kBadUsage;
}

int run_command(int argc, char** argv) {
  CLI::App app("dxslam: visual SLAM with deep features for RGB-D cameras", "dxslam");
  add_commands(app);
  refuse_empty_values(app);
  try {
    require_known_words(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {
    return say_usage(app, argc, argv, e);
  } catch (const std::exception&) {
    const Failure failure = current_failure();
    warn("{}", failure.sentence);
    return failure.code;
  }
  return kSuccess;
}

// A reader that went away wanted no more: no failure. All else is.
int check_stdout(int code) {
  const int error = stdout_error();
  if (error == 0 || error == EPIPE || stop_requested()) return code;
  warn("stdout cannot be written: {}", std::strerror(error));
  return code == kSuccess ? kBadInput : code;
}

int after_stop(int code) {
  const bool goes_well = code == kSuccess || code == kTrackingFailed;
  return stop_requested() && goes_well ? kInterrupted : code;
}

}  // namespace
}  // namespace dxslam::apps

int main(int argc, char** argv) {
  using namespace dxslam::apps;
  prepare_process();
  return end_process(check_stdout(after_stop(run_command(argc, argv))));
}
