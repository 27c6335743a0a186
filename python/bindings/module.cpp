// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <nanobind/nanobind.h>

NB_MODULE(_dxslam, m) {
  m.doc() = "dxslam in C++; use the package dxslam.";
  m.attr("__version__") = DXSLAM_VERSION;
}
