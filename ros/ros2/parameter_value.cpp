// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/parameter_value.h"

#include <array>
#include <charconv>
#include <cstddef>

namespace dxslam::ros2 {
namespace {

using Message = rcl_interfaces::msg::ParameterValue;

std::string show(bool value) { return value ? "true" : "false"; }
std::string show(const std::string& value) { return "'" + value + "'"; }
template <class Number>
std::string show(Number value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}
std::string show(std::monostate /*none*/) { return "nothing"; }
template <class Element>
std::string show(const std::vector<Element>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i ? ", " : "") + show(static_cast<Element>(values[i]));
  }
  return text + "]";
}

template <class Array>
auto to_vector(const Array& array) {
  return std::vector(array.values, array.values + array.size);
}

}  // namespace

std::string_view type_name(const ParameterValue& value) {
  static constexpr std::array<std::string_view, std::variant_size_v<ParameterValue>> kNames{
      "nothing",
      "true or false",
      "a whole number",
      "a number",
      "a text",
      "a list of bytes",
      "a list of true or false",
      "a list of whole numbers",
      "a list of numbers",
      "a list of texts"};
  return kNames[value.index()];
}

std::string to_string(const ParameterValue& value) {
  return std::visit([](const auto& held) { return show(held); }, value);
}

rcl_interfaces::msg::ParameterValue to_message(const ParameterValue& value) {
  Message message;
  message.type = type_of(value);
  switch (message.type) {
    case 1:
      message.bool_value = std::get<1>(value);
      break;
    case 2:
      message.integer_value = std::get<2>(value);
      break;
    case 3:
      message.double_value = std::get<3>(value);
      break;
    case 4:
      message.string_value = std::get<4>(value);
      break;
    case 5:
      message.byte_array_value = std::get<5>(value);
      break;
    case 6:
      message.bool_array_value = std::get<6>(value);
      break;
    case 7:
      message.integer_array_value = std::get<7>(value);
      break;
    case 8:
      message.double_array_value = std::get<8>(value);
      break;
    case 9:
      message.string_array_value = std::get<9>(value);
      break;
    default:
      break;
  }
  return message;
}

ParameterValue from_message(const rcl_interfaces::msg::ParameterValue& message) {
  switch (message.type) {
    case 1:
      return message.bool_value;
    case 2:
      return message.integer_value;
    case 3:
      return message.double_value;
    case 4:
      return message.string_value;
    case 5:
      return message.byte_array_value;
    case 6:
      return message.bool_array_value;
    case 7:
      return message.integer_array_value;
    case 8:
      return message.double_array_value;
    case 9:
      return message.string_array_value;
    default:
      return std::monostate();
  }
}

ParameterValue from_variant(const rcl_variant_t& variant) {
  if (variant.bool_value) return *variant.bool_value;
  if (variant.integer_value) return *variant.integer_value;
  if (variant.double_value) return *variant.double_value;
  if (variant.string_value) return std::string(variant.string_value);
  if (variant.byte_array_value) return to_vector(*variant.byte_array_value);
  if (variant.bool_array_value) return to_vector(*variant.bool_array_value);
  if (variant.integer_array_value) return to_vector(*variant.integer_array_value);
  if (variant.double_array_value) return to_vector(*variant.double_array_value);
  if (const auto* texts = variant.string_array_value) {
    return std::vector<std::string>(texts->data, texts->data + texts->size);
  }
  return std::monostate();
}

}  // namespace dxslam::ros2
