// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/ros_message.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr std::uint32_t kMostElements = 1U << 20U;  // of a list of anything but bytes

/// Fields of a message one after another. ROS 1 packs them; CDR aligns each to its size, counted
/// from behind a head of four bytes that says which end comes first.
class FieldReader {
 public:
  FieldReader(std::string_view bytes, MessageEncoding encoding, const std::string& where)
      : bytes_(bytes), where_(where) {
    if (encoding == MessageEncoding::kRos1) return;
    const std::string_view head = take(4);
    const auto kind = static_cast<unsigned char>(head[1]);
    constexpr unsigned char kPlainCdr2 = 6;
    if (head[0] != 0 || (kind > 1 && kind != kPlainCdr2 && kind != kPlainCdr2 + 1)) {
      throw InputError(where + ": a message in an encoding that is not known, expected CDR");
    }
    cdr_ = true;
    swap_ = kind % 2 == 0;
    widest_ = kind >= kPlainCdr2 ? 4 : 8;
    origin_ = at_;
  }

  template <class Number>
  Number number() {
    align(sizeof(Number));
    const std::string_view source = take(sizeof(Number));
    std::array<char, sizeof(Number)> raw{};
    for (std::size_t i = 0; i < raw.size(); ++i) {
      raw[i] = source[swap_ ? raw.size() - 1 - i : i];
    }
    Number value;
    std::memcpy(&value, raw.data(), raw.size());
    return value;
  }

  std::string text() {
    std::string_view characters = bytes();
    if (cdr_ && !characters.empty() && characters.back() == '\0') characters.remove_suffix(1);
    return std::string(characters);
  }
  std::string_view bytes() {
    const auto count = number<std::uint32_t>();
    return take(count);
  }
  std::uint32_t count() {
    const auto n = number<std::uint32_t>();
    if (n > kMostElements) {
      throw InputError(fmt::format("{}: a list of {} in a message, expected at most {}", where_, n,
                                   kMostElements));
    }
    return n;
  }

  RosHeader header() {
    if (!cdr_) number<std::uint32_t>();  // sequence number
    RosHeader header;
    const std::int64_t seconds =
        cdr_ ? std::int64_t{number<std::int32_t>()} : std::int64_t{number<std::uint32_t>()};
    header.stamp_ns = seconds * 1'000'000'000 + number<std::uint32_t>();
    header.frame = text();
    return header;
  }

  // Nothing where the numbers are no transform.
  std::optional<SE3> transform() {
    Eigen::Vector3d translation;
    for (int i = 0; i < 3; ++i) translation[i] = number<double>();
    Eigen::Quaterniond rotation;
    for (double* value : {&rotation.x(), &rotation.y(), &rotation.z(), &rotation.w()}) {
      *value = number<double>();
    }
    constexpr double kNorm = 0.5;  // a rotation has 1
    const double norm = rotation.norm();
    if (!translation.allFinite() || !(norm > kNorm && norm < 1.0 / kNorm)) return std::nullopt;
    return SE3(rotation.normalized(), translation);
  }

 private:
  std::string_view take(std::size_t count) {
    if (count > bytes_.size() - at_) {
      throw InputError(fmt::format("{}: a message ends too early, {} bytes are missing", where_,
                                   count - (bytes_.size() - at_)));
    }
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }
  void align(std::size_t size) {
    if (!cdr_) return;
    const std::size_t step = std::min(size, widest_);
    const std::size_t beyond = (at_ - origin_) % step;
    if (beyond != 0) take(step - beyond);
  }

  std::string_view bytes_;
  const std::string& where_;
  std::size_t at_ = 0;
  std::size_t origin_ = 0;
  std::size_t widest_ = 8;
  bool cdr_ = false;
  bool swap_ = false;
};

}  // namespace

RosHeader read_ros_header(std::string_view bytes, MessageEncoding encoding,
                          const std::string& where) {
  return FieldReader(bytes, encoding, where).header();
}

RosImage read_ros_image(std::string_view bytes, MessageEncoding encoding,
                        const std::string& where) {
  FieldReader reader(bytes, encoding, where);
  RosImage image;
  image.header = reader.header();
  image.height = reader.number<std::uint32_t>();
  image.width = reader.number<std::uint32_t>();
  image.encoding = reader.text();
  image.big_endian = reader.number<std::uint8_t>() != 0;
  image.step = reader.number<std::uint32_t>();
  image.data = reader.bytes();
  return image;
}

RosCompressedImage read_ros_compressed_image(std::string_view bytes, MessageEncoding encoding,
                                             const std::string& where) {
  FieldReader reader(bytes, encoding, where);
  RosCompressedImage image;
  image.header = reader.header();
  image.format = reader.text();
  image.data = reader.bytes();
  return image;
}

RosCameraInfo read_ros_camera_info(std::string_view bytes, MessageEncoding encoding,
                                   const std::string& where) {
  FieldReader reader(bytes, encoding, where);
  RosCameraInfo info;
  info.header = reader.header();
  info.height = reader.number<std::uint32_t>();
  info.width = reader.number<std::uint32_t>();
  info.distortion_model = reader.text();
  info.d.resize(reader.count());
  for (double& value : info.d) value = reader.number<double>();
  for (double& value : info.k) value = reader.number<double>();
  for (int i = 0; i < 9; ++i) reader.number<double>();  // rotation of a stereo camera
  for (double& value : info.p) value = reader.number<double>();
  return info;
}

std::string read_ros_string(std::string_view bytes, MessageEncoding encoding,
                            const std::string& where) {
  return FieldReader(bytes, encoding, where).text();
}

float read_ros_float(std::string_view bytes, MessageEncoding encoding, const std::string& where) {
  return FieldReader(bytes, encoding, where).number<float>();
}

SE3 read_ros_transform(std::string_view bytes, MessageEncoding encoding, const std::string& where) {
  FieldReader reader(bytes, encoding, where);
  const std::optional<SE3> transform = reader.transform();
  if (transform) return *transform;
  throw InputError(where + ": a transform that is none, expected finite numbers and a rotation");
}

std::vector<RosTransform> read_ros_transforms(std::string_view bytes, MessageEncoding encoding,
                                              const std::string& where) {
  FieldReader reader(bytes, encoding, where);
  std::vector<RosTransform> transforms;
  for (std::uint32_t left = reader.count(); left > 0; --left) {
    RosTransform transform;
    transform.parent = reader.header().frame;
    transform.child = reader.text();
    const std::optional<SE3> parent_from_child = reader.transform();
    if (!parent_from_child) continue;
    transform.parent_from_child = *parent_from_child;
    transforms.push_back(std::move(transform));
  }
  return transforms;
}

}  // namespace dxslam
