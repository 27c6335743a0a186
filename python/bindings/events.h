// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include "slam/event_stream.h"

namespace dxslam::python {

/// The message as an object of the class of its event.
nanobind::object to_event(const MessagePtr& message);

}  // namespace dxslam::python
