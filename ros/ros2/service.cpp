// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/service.h"

#include "ros2/error.h"

namespace dxslam::ros2 {

ServiceBase::ServiceBase(NodeHandle node, const rosidl_service_type_support_t& type,
                         const std::string& name, const Qos& qos)
    : node_(std::move(node)), handle_(rcl_get_zero_initialized_service()) {
  rcl_service_options_t options = rcl_service_get_default_options();
  options.qos = qos;
  check(rcl_service_init(&handle_, node_.get(), &type, name.c_str(), &options),
        "the service '" + name + "' cannot be offered");
  name_ = rcl_service_get_service_name(&handle_);
}

ServiceBase::~ServiceBase() {
  if (rcl_service_fini(&handle_, node_.get()) != RCL_RET_OK) take_rcl_error();
}

bool ServiceBase::take_any(rmw_request_id_t& id, void* request) {
  const rcl_ret_t result = rcl_take_request(&handle_, &id, request);
  if (result == RCL_RET_SERVICE_TAKE_FAILED) return false;
  check(result, "a request of " + name_ + " cannot be read");
  return true;
}

void ServiceBase::send_any(rmw_request_id_t& id, void* response) {
  const rcl_ret_t result = rcl_send_response(&handle_, &id, response);
  if (result == RCL_RET_TIMEOUT) {
    take_rcl_error();
    return;
  }
  check(result, "an answer of " + name_ + " cannot be sent");
}

void ServiceBase::count(WaitSizes& sizes) const { ++sizes.services; }

void ServiceBase::add_to(rcl_wait_set_t& set) {
  check(rcl_wait_set_add_service(&set, &handle_, &index_), "cannot wait for " + what());
}

bool ServiceBase::is_ready(const rcl_wait_set_t& set) const { return set.services[index_]; }

std::string ServiceBase::what() const { return "the service " + name_; }

}  // namespace dxslam::ros2
