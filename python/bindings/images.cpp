// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/images.h"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "core/error.h"
#include "core/frame.h"

namespace dxslam::python {
namespace {

// Arrays that are no longer needed, until somebody has the GIL.
class Trash {
 public:
  void put(ImageArgument* array) {
    const std::lock_guard lock(mutex_);
    arrays_.push_back(array);
  }
  void empty() {
    std::vector<ImageArgument*> arrays;
    {
      const std::lock_guard lock(mutex_);
      arrays.swap(arrays_);
    }
    for (const ImageArgument* array : arrays) delete array;
  }

 private:
  std::mutex mutex_;
  std::vector<ImageArgument*> arrays_;
};

Trash& trash() {
  static Trash* const kForever = new Trash;  // threads may outlive static variables
  return *kForever;
}

// Makes OpenCV's count of references keep an array of Python's.
class ArrayKeeper final : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override {
    trash().put(static_cast<ImageArgument*>(data->userdata));
    delete data;
  }

  cv::Mat keep(const ImageArgument& array, int type, std::size_t step) const {
    const int rows = static_cast<int>(array.shape(0));
    cv::Mat image(rows, static_cast<int>(array.shape(1)), type, const_cast<void*>(array.data()),
                  step);
    auto* data = new cv::UMatData(this);
    data->data = data->origdata = image.data;
    data->size = step * static_cast<std::size_t>(rows);
    data->refcount = 1;
    data->userdata = new ImageArgument(array);
    image.u = data;
    return image;
  }
};

const ArrayKeeper& keeper() {
  static const ArrayKeeper* const kForever = new ArrayKeeper;
  return *kForever;
}

std::size_t channels_of(const ImageArgument& array) {
  return array.ndim() == 3 ? array.shape(2) : 1;
}

cv::Mat copy(const ImageArgument& array, int type) {
  const auto size = static_cast<std::size_t>(array.itemsize());
  const std::size_t channels = channels_of(array);
  cv::Mat image(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), type);
  const auto* from = static_cast<const std::uint8_t*>(array.data());
  const auto bytes = [&](std::size_t axis) {
    return array.stride(axis) * static_cast<std::int64_t>(size);
  };
  const std::int64_t down = bytes(0), right = bytes(1), deep = array.ndim() == 3 ? bytes(2) : 0;
  for (int row = 0; row < image.rows; ++row) {
    std::uint8_t* to = image.ptr(row);
    for (int column = 0; column < image.cols; ++column) {
      for (std::size_t c = 0; c < channels; ++c, to += size) {
        std::memcpy(to, from + row * down + column * right + static_cast<std::int64_t>(c) * deep,
                    size);
      }
    }
  }
  return image;
}

cv::Mat shared_or_copied(const ImageArgument& array, int type) {
  const auto channels = static_cast<std::int64_t>(channels_of(array));
  const std::int64_t row = array.stride(0);
  const bool packed = array.stride(1) == channels && (array.ndim() == 2 || array.stride(2) == 1) &&
                      row >= static_cast<std::int64_t>(array.shape(1)) * channels;
  if (!packed) return copy(array, type);
  return keeper().keep(array, type, static_cast<std::size_t>(row) * array.itemsize());
}

std::string found(const ImageArgument& array) {
  static const char* const kKinds[] = {"int",    "uint",    "float", "object",
                                       "bfloat", "complex", "bool"};
  const std::size_t code = array.dtype().code;
  std::string text =
      fmt::format("{}{} of shape (", code < std::size(kKinds) ? kKinds[code] : "type",
                  static_cast<int>(array.dtype().bits));
  for (std::size_t i = 0; i < array.ndim(); ++i) {
    text += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void refuse(const char* what, const ImageArgument& array, const char* expected) {
  throw InputError(fmt::format("{} is {}, expected {}", what, found(array), expected));
}

bool is_empty(const ImageArgument& array) {
  constexpr std::size_t kLargest = 1U << 16U;  // pixels; so that sizes can be told by an int
  return array.size() == 0 || array.shape(0) > kLargest || array.shape(1) > kLargest;
}

template <class A>
A array_of(const cv::Mat& image, std::size_t ndim, std::size_t width, nb::dlpack::dtype type) {
  const nb::capsule owner(new cv::Mat(image),
                          [](void* p) noexcept { delete static_cast<cv::Mat*>(p); });
  const std::size_t shape[] = {static_cast<std::size_t>(image.rows),
                               static_cast<std::size_t>(image.cols), width};
  const auto row = static_cast<std::int64_t>(image.step[0] / image.elemSize1());
  const std::int64_t strides[] = {row, ndim == 3 ? static_cast<std::int64_t>(width) : 1, 1};
  return A(image.data, ndim, shape, owner, strides, type);
}

}  // namespace

cv::Mat color_image(const ImageArgument& array) {
  const bool fits = array.dtype() == nb::dtype<std::uint8_t>() &&
                    (array.ndim() == 2 || (array.ndim() == 3 && array.shape(2) == 3));
  if (!fits || is_empty(array)) {
    refuse("the colour image", array, "uint8 of shape (height, width, 3), BGR, or (height, width)");
  }
  return shared_or_copied(array, array.ndim() == 3 ? CV_8UC3 : CV_8UC1);
}

cv::Mat depth_image(const ImageArgument& array, double depth_factor) {
  const bool metres = array.dtype() == nb::dtype<float>();
  const bool raw = array.dtype() == nb::dtype<std::uint16_t>();
  if (array.ndim() != 2 || !(metres || raw) || is_empty(array)) {
    refuse("the depth image", array,
           "float32 (metres) or uint16 (divided by depth_factor) of shape (height, width)");
  }
  if (metres) return shared_or_copied(array, CV_32FC1);
  cv::Mat depth;
  shared_or_copied(array, CV_16UC1).convertTo(depth, CV_32F, 1.0 / depth_factor);
  return depth;
}

void require_size(const cv::Mat& color, const cv::Mat& depth, const Camera& camera) {
  const cv::Size size(camera.width, camera.height);
  for (const auto& [name, image] : {std::pair("colour", &color), std::pair("depth", &depth)}) {
    if (image->empty() || image->size() == size) continue;
    throw InputError(fmt::format("the {} image is {} x {}, expected {} x {}, the camera's size",
                                 name, image->cols, image->rows, size.width, size.height));
  }
}

ColorArray color_array(const cv::Mat& image) {
  const auto channels = static_cast<std::size_t>(image.channels());
  return array_of<ColorArray>(image, channels == 1 ? 2 : 3, channels, nb::dtype<std::uint8_t>());
}

DepthArray depth_array(const cv::Mat& image) {
  return array_of<DepthArray>(image, 2, 1, nb::dtype<float>());
}

cv::Mat descriptor_matrix(const ImageArgument& array) {
  const bool floats = array.dtype() == nb::dtype<float>();
  if (array.ndim() != 2 || !(floats || array.dtype() == nb::dtype<std::uint8_t>()) ||
      array.shape(1) == 0) {
    refuse("the descriptors", array, "float32 or uint8 of shape (N, D)");
  }
  return shared_or_copied(array, floats ? CV_32FC1 : CV_8UC1);
}

nb::ndarray<nb::numpy, nb::ro, nb::ndim<2>> descriptor_array(const cv::Mat& descriptors) {
  return array_of<nb::ndarray<nb::numpy, nb::ro, nb::ndim<2>>>(
      descriptors, 2, 1,
      descriptors.depth() == CV_32F ? nb::dtype<float>() : nb::dtype<std::uint8_t>());
}

void release_arrays() { trash().empty(); }

void bind_images(nb::module_& m) {
  nb::class_<RgbdImage>(m, "Image",
                        "An image with depth, of a source. Arrays are read-only and share the "
                        "memory of C++.")
      .def_ro("index", &RgbdImage::index, "Position in the recording, from 0.")
      .def_ro("stamp", &RgbdImage::stamp, "Seconds.")
      .def_prop_ro(
          "color", [](const RgbdImage& image) { return color_array(image.color); }, kOwned,
          "(H, W, 3) uint8, BGR, or (H, W) uint8, grey.")
      .def_prop_ro(
          "depth",
          [](const RgbdImage& image) {
            return image.depth.empty() ? std::optional<DepthArray>()
                                       : std::optional<DepthArray>(depth_array(image.depth));
          },
          kOwned,
          "(H, W) float32, metres along the axis of the colour camera, registered to its pixels; "
          "0: "
          "no reading. None where the image has no depth.")
      .def("__repr__", [](const RgbdImage& image) {
        return fmt::format("Image(index={}, stamp={:.6f}, {} x {}{})", image.index, image.stamp,
                           image.color.cols, image.color.rows,
                           image.depth.empty() ? "" : ", with depth");
      });
}

}  // namespace dxslam::python
