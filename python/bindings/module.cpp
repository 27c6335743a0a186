// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <nanobind/stl/string.h>

#include "bindings/bindings.h"
#include "bindings/shutdown.h"
#include "features/data_directory.h"

NB_MODULE(_dxslam, m) {
  using namespace dxslam::python;
  m.doc() = "dxslam in C++, for the package dxslam.";
  m.attr("__version__") = DXSLAM_VERSION;
  bind_errors(m);
  bind_camera(m);
  bind_options(m);
  bind_trajectory(m);
  bind_images(m);
  bind_features(m);
  bind_map(m);
  bind_events(m);
  bind_system(m);
  bind_source(m);
  bind_evaluation(m);
  m.def("set_data_directory", &dxslam::set_data_directory, nb::arg("folder"),
        "Sets the folder that holds `models/` and `manifests/`; $DXSLAM_DATA goes before it.");
  m.def("data_directory", &dxslam::data_directory,
        "The folder that holds `models/` and `manifests/`.");
  end_all_at_exit();
}
