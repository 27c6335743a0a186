// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/context.h"

#include <rcl/arguments.h>
#include <rcl/init.h>
#include <rcl/init_options.h>
#include <rcl/logging.h>
#include <rcutils/logging.h>

#include <atomic>
#include <mutex>

#include "ros2/error.h"

namespace dxslam::ros2 {
namespace {

// rcl's handlers share buffers, so that one thread at a time may log.
void write_log(const rcutils_log_location_t* location, int severity, const char* name,
               rcutils_time_point_value_t stamp, const char* format, va_list* values) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  rcl_logging_multiple_output_handler(location, severity, name, stamp, format, values);
}

void close(rcl_context_t* context) {
  if (rcl_context_is_valid(context) && rcl_shutdown(context) != RCL_RET_OK) take_rcl_error();
  if (rcl_logging_fini() != RCL_RET_OK) take_rcl_error();
  if (rcl_context_fini(context) != RCL_RET_OK) take_rcl_error();
  delete context;
}

std::vector<std::string> without_ros(int argc, const char* const* argv,
                                     const rcl_arguments_t& parsed) {
  const int count = rcl_arguments_get_count_unparsed(&parsed);
  std::vector<std::string> rest;
  if (count <= 0) return rest;
  rcl_allocator_t allocator = rcl_get_default_allocator();
  int* indices = nullptr;
  check(rcl_arguments_get_unparsed(&parsed, allocator, &indices), "the command line is unusable");
  for (int i = 0; i < count; ++i) {
    if (indices[i] > 0 && indices[i] < argc) rest.emplace_back(argv[indices[i]]);
  }
  allocator.deallocate(indices, allocator.state);
  return rest;
}

}  // namespace

Context::Context(int argc, const char* const* argv) {
  rcl_allocator_t allocator = rcl_get_default_allocator();
  rcl_init_options_t options = rcl_get_zero_initialized_init_options();
  check(rcl_init_options_init(&options, allocator), "ROS 2 cannot be started");
  auto context = std::make_unique<rcl_context_t>(rcl_get_zero_initialized_context());
  const rcl_ret_t result = rcl_init(argc, argv, &options, context.get());
  const std::string reason = result == RCL_RET_OK ? "" : take_rcl_error();
  if (rcl_init_options_fini(&options) != RCL_RET_OK) take_rcl_error();
  if (result == RCL_RET_INVALID_ROS_ARGS) {
    throw Error("what follows --ros-args cannot be read: " + reason);
  }
  if (result != RCL_RET_OK) throw Error("ROS 2 cannot be started: " + reason);
  handle_ = {context.release(), close};
  check(
      rcl_logging_configure_with_output_handler(&handle_->global_arguments, &allocator, write_log),
      "the logging of ROS 2 cannot be set up");
  if (const int unknown = rcl_arguments_get_count_unparsed_ros(&handle_->global_arguments);
      unknown > 0) {
    int* indices = nullptr;
    check(rcl_arguments_get_unparsed_ros(&handle_->global_arguments, allocator, &indices),
          "the command line is unusable");
    const std::string first = argv[indices[0]];
    allocator.deallocate(indices, allocator.state);
    throw Error("'" + first + "' after --ros-args is no argument that ROS 2 knows");
  }
  arguments_ = without_ros(argc, argv, handle_->global_arguments);
}

}  // namespace dxslam::ros2
