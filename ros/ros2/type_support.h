// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rosidl_runtime_c/message_type_support_struct.h>
#include <rosidl_runtime_c/service_type_support_struct.h>

#include <rosidl_typesupport_cpp/message_type_support.hpp>
#include <rosidl_typesupport_cpp/service_type_support.hpp>

namespace dxslam::ros2 {

/// How a message is put on the wire. The layer's code without templates knows types only by this.
template <class Message>
const rosidl_message_type_support_t& message_type() {
  return *rosidl_typesupport_cpp::get_message_type_support_handle<Message>();
}

template <class Service>
const rosidl_service_type_support_t& service_type() {
  return *rosidl_typesupport_cpp::get_service_type_support_handle<Service>();
}

}  // namespace dxslam::ros2
