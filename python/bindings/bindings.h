// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

// The parts of the module, in the order in which they are bound: one file each.
namespace dxslam::python {

namespace nb = nanobind;

void bind_errors(nb::module_& m);
void bind_camera(nb::module_& m);
void bind_options(nb::module_& m);
void bind_trajectory(nb::module_& m);
void bind_images(nb::module_& m);
void bind_features(nb::module_& m);
void bind_map(nb::module_& m);
void bind_events(nb::module_& m);
void bind_system(nb::module_& m);
void bind_source(nb::module_& m);
void bind_evaluation(nb::module_& m);

}  // namespace dxslam::python
