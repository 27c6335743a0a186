// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

// All that the library promises (docs/cpp_library.md). What these headers include beside is
// installed with them, but may change from one version to the next.

// Images, cameras, poses, errors.
#include "core/camera.h"
#include "core/error.h"
#include "core/features.h"
#include "core/frame.h"
#include "core/image_source.h"
#include "core/options.h"
#include "core/se3.h"
#include "core/sequence.h"
#include "core/trajectory.h"

// Features, and where models are looked for.
#include "features/data_directory.h"
#include "features/extractor.h"
#include "features/extractor_factory.h"

// Calibrations, configurations, images, trajectories and recordings of files.
#include "io/calibration/calibration.h"
#include "io/formats/options_yaml.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/image_file.h"
#include "io/recordings/recording_writer.h"
#include "io/recordings/sequence_reader.h"
#include "io/sources/open_source.h"

// The system itself.
#include "slam/event_reader.h"
#include "slam/event_stream.h"
#include "slam/observer.h"
#include "slam/run_statistics.h"
#include "slam/system.h"
#include "slam/system_options.h"

// Maps, on the disk and another day.
#include "map/map.h"
#include "map_files/map_export.h"
#include "map_files/map_file.h"
#include "relocalization/relocalizer.h"
#include "slam/stored_system.h"

// How good a trajectory is.
#include "evaluation/association.h"
#include "evaluation/ate.h"
#include "evaluation/rpe.h"

#include "version.h"
