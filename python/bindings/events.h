// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "slam/event_stream.h"

namespace dxslam::python {

/// The message as an object of the class of its event.
nanobind::object to_event(const MessagePtr& message);

/// Of an iterable of such classes; all where there is none. Raises TypeError for other things.
EventKinds kinds_of(const std::optional<nanobind::iterable>& classes);

}  // namespace dxslam::python
