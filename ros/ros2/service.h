// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/service.h>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "ros2/entity.h"
#include "ros2/qos.h"
#include "ros2/type_support.h"

namespace dxslam::ros2 {

/// What Service is without its type. Made by Node.
class ServiceBase : public Entity {
 public:
  ServiceBase(NodeHandle node, const rosidl_service_type_support_t& type, const std::string& name,
              const Qos& qos);
  ~ServiceBase() override;

  /// The full name, after remapping.
  const std::string& name() const { return name_; }

  void count(WaitSizes& sizes) const override;
  void add_to(rcl_wait_set_t& set) override;
  bool is_ready(const rcl_wait_set_t& set) const override;
  std::string what() const override;

 protected:
  bool take_any(rmw_request_id_t& id, void* request);
  /// A client that went away meanwhile is no error.
  void send_any(rmw_request_id_t& id, void* response);

 private:
  NodeHandle node_;
  rcl_service_t handle_;
  std::size_t index_ = 0;
  std::string name_;
};

template <class Type>
class Service final : public ServiceBase {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  /// Called in the executor's thread; fills the response. If it throws, the response is sent as it
  /// is by then, so that nobody waits for ever, and the executor logs the error.
  using Callback = std::function<void(const Request&, Response&)>;

  Service(NodeHandle node, const std::string& name, const Qos& qos, Callback callback)
      : ServiceBase(std::move(node), service_type<Type>(), name, qos),
        callback_(std::move(callback)) {}

  void execute() override {
    rmw_request_id_t id{};
    Request request;
    if (!take_any(id, &request)) return;
    Response response;
    try {
      callback_(request, response);
    } catch (...) {
      send_any(id, &response);
      throw;
    }
    send_any(id, &response);
  }

 private:
  Callback callback_;
};

}  // namespace dxslam::ros2
