// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/ros_message_writer.h"

#include <initializer_list>

#include "core/error.h"
#include "io/bags/byte_writer.h"
#include "io/calibration/foreign_calibration.h"

namespace dxslam {
namespace {

// A type that a definition names follows it.
std::string nested(const std::string& name, const std::string& definition) {
  return std::string(80, '=') + "\nMSG: " + name + "\n" + definition;
}

std::string header_types() {
  return nested("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n") +
         nested("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
}

/// Fields one after another, each aligned to its size behind a head of four bytes.
class FieldWriter {
 public:
  FieldWriter() { bytes_.raw(std::string_view("\0\1\0\0", kHead)); }

  template <class Number>
  void number(Number value) {
    while ((bytes_.bytes().size() - kHead) % sizeof(Number) != 0) bytes_.number(char{0});
    bytes_.number(value);
  }
  void text(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.raw(text).number(char{0});
  }
  void numbers(std::initializer_list<double> values) {
    for (const double value : values) number(value);
  }
  void header(std::int64_t stamp_ns, const std::string& frame) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    number(static_cast<std::int32_t>(stamp_ns / kSecond));
    number(static_cast<std::uint32_t>(stamp_ns % kSecond));
    text(frame);
  }
  void rows(const cv::Mat& image) {
    const std::size_t row_bytes = image.elemSize() * static_cast<std::size_t>(image.cols);
    number(static_cast<std::uint32_t>(row_bytes * static_cast<std::size_t>(image.rows)));
    for (int y = 0; y < image.rows; ++y) {
      bytes_.raw({reinterpret_cast<const char*>(image.ptr(y)), row_bytes});
    }
  }
  const std::string& bytes() const { return bytes_.bytes(); }

 private:
  static constexpr std::size_t kHead = 4;
  ByteWriter bytes_;
};

const char* encoding_of(const cv::Mat& image) {
  switch (image.type()) {
    case CV_8UC1:
      return "mono8";
    case CV_8UC3:
      return "bgr8";
    case CV_16UC1:
      return "16UC1";
    case CV_32FC1:
      return "32FC1";
    default:
      throw ContractError("an image is CV_8UC1, CV_8UC3, CV_16UC1 or CV_32FC1");
  }
}

}  // namespace

RosType ros_image_type() {
  return {"sensor_msgs/msg/Image",
          "std_msgs/Header header\n"
          "uint32 height\n"
          "uint32 width\n"
          "string encoding\n"
          "uint8 is_bigendian\n"
          "uint32 step\n"
          "uint8[] data\n" +
              header_types()};
}

RosType ros_camera_info_type() {
  return {"sensor_msgs/msg/CameraInfo",
          "std_msgs/Header header\n"
          "uint32 height\n"
          "uint32 width\n"
          "string distortion_model\n"
          "float64[] d\n"
          "float64[9] k\n"
          "float64[9] r\n"
          "float64[12] p\n"
          "uint32 binning_x\n"
          "uint32 binning_y\n"
          "sensor_msgs/RegionOfInterest roi\n" +
              header_types() +
              nested("sensor_msgs/RegionOfInterest",
                     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n"
                     "bool do_rectify\n")};
}

RosType ros_string_type() { return {"std_msgs/msg/String", "string data\n"}; }

std::string write_ros_image(const cv::Mat& image, std::int64_t stamp_ns, const std::string& frame) {
  FieldWriter fields;
  fields.header(stamp_ns, frame);
  fields.number(static_cast<std::uint32_t>(image.rows));
  fields.number(static_cast<std::uint32_t>(image.cols));
  fields.text(encoding_of(image));
  fields.number(std::uint8_t{0});  // little-endian
  fields.number(
      static_cast<std::uint32_t>(image.elemSize() * static_cast<std::size_t>(image.cols)));
  fields.rows(image);
  return fields.bytes();
}

std::string write_ros_camera_info(const Camera& camera, std::int64_t stamp_ns,
                                  const std::string& frame) {
  FieldWriter fields;
  fields.header(stamp_ns, frame);
  fields.number(static_cast<std::uint32_t>(camera.height));
  fields.number(static_cast<std::uint32_t>(camera.width));
  fields.text(ros_lens_name(*camera.lens.model));
  const std::size_t coefficients = camera.lens.model->parameter_count();
  fields.number(static_cast<std::uint32_t>(coefficients));
  for (std::size_t i = 0; i < coefficients; ++i) fields.number(camera.lens.parameters[i]);
  fields.numbers({camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0});
  fields.numbers({1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  fields.numbers(
      {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0});
  for (int i = 0; i < 6; ++i) fields.number(std::uint32_t{0});  // binning and region: all of it
  fields.number(std::uint8_t{0});
  return fields.bytes();
}

std::string write_ros_string(const std::string& text) {
  FieldWriter fields;
  fields.text(text);
  return fields.bytes();
}

}  // namespace dxslam
