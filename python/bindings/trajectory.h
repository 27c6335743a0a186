// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include "core/trajectory.h"

// A class of its own, no list.
NB_MAKE_OPAQUE(dxslam::Trajectory)
