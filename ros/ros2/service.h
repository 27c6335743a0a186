// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rcl/service.h>

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "ros2/entity.h"
#include "ros2/qos.h"
#include "ros2/type_support.h"

namespace dxslam::ros2 {

/// What Service is without its type. Made by Node.
class ServiceBase : public Entity, public std::enable_shared_from_this<ServiceBase> {
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

  /// Any thread. A client that went away meanwhile is no error. For Answer.
  void send_any(rmw_request_id_t& id, void* response);

 protected:
  bool take_any(rmw_request_id_t& id, void* request);

 private:
  NodeHandle node_;
  rcl_service_t handle_;
  std::size_t index_ = 0;
  std::string name_;
};

/// The answer to one request, to be given now or later, by any thread. If the last owner drops it
/// before, or a callback throws, what is in `response` by then is sent, so that nobody waits for
/// ever. If the service is gone, nothing is.
template <class Type>
class Answer {
 public:
  Answer(std::weak_ptr<ServiceBase> service, const rmw_request_id_t& id)
      : service_(std::move(service)), id_(id) {}
  ~Answer() {
    try {
      send();
    } catch (const std::exception&) {  // there is nobody left to tell
    }
  }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  typename Type::Response response;

  /// Once; further calls do nothing.
  void send() {
    if (is_sent_) return;
    is_sent_ = true;
    if (const auto service = service_.lock()) service->send_any(id_, &response);
  }

 private:
  std::weak_ptr<ServiceBase> service_;
  rmw_request_id_t id_;
  bool is_sent_ = false;
};

template <class Type>
class Service final : public ServiceBase {
 public:
  using Request = typename Type::Request;
  using Response = typename Type::Response;
  using AnswerPtr = std::shared_ptr<Answer<Type>>;
  /// Called in the executor's thread; fills the response, which is sent also where it throws.
  using Callback = std::function<void(const Request&, Response&)>;
  /// The same for what takes long: the answer may be kept, and sent later.
  using DeferredCallback = std::function<void(const Request&, AnswerPtr)>;

  Service(NodeHandle node, const std::string& name, const Qos& qos, DeferredCallback callback)
      : ServiceBase(std::move(node), service_type<Type>(), name, qos),
        callback_(std::move(callback)) {}

  void execute() override {
    rmw_request_id_t id{};
    Request request;
    if (!take_any(id, &request)) return;
    callback_(request, std::make_shared<Answer<Type>>(weak_from_this(), id));
  }

 private:
  DeferredCallback callback_;
};

}  // namespace dxslam::ros2
