// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <cstdio>
#include <exception>

#include "apps/commands.h"
#include "core/error.h"

int main(int argc, char** argv) {
  using namespace dxslam;
  CLI::App app("dxslam: visual SLAM with deep features for RGB-D cameras", "dxslam");
  app.set_version_flag("--version", "dxslam " DXSLAM_VERSION);
  app.require_subcommand(1);
  apps::add_run_command(app);
  apps::add_lifelong_command(app);
  apps::add_eval_command(app);
  apps::add_synth_command(app);
  apps::add_config_command(app);
  apps::add_features_command(app);
  apps::add_vocab_command(app);
  apps::add_loops_command(app);
  apps::add_map_command(app);
  apps::add_relocalize_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? apps::kSuccess : apps::kBadUsage;
  } catch (const InputError& e) {
    std::fprintf(stderr, "dxslam: %s\n", e.what());
    return apps::kBadInput;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dxslam: internal error: %s\n", e.what());
    return apps::kInternalError;
  }
  return apps::kSuccess;
}
