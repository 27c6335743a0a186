// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <opencv2/core.hpp>

#include "core/camera.h"

namespace dxslam::python {

namespace nb = nanobind;

/// What Python hands over; of any type, so that a wrong one is told in a sentence.
using ImageArgument = nb::ndarray<nb::ro, nb::device::cpu>;
using ColorArray = nb::ndarray<nb::numpy, const std::uint8_t>;
using DepthArray = nb::ndarray<nb::numpy, const float, nb::shape<-1, -1>>;

/// The array as an image that shares its memory and keeps it, as long as anybody in C++ has the
/// image; a copy where pixels do not lie one behind the other. Throws InputError for what is no
/// uint8 of shape H x W or H x W x 3. With the GIL.
cv::Mat color_image(const ImageArgument& array);
/// Metres: the array, shared as above, where it is float32 of shape H x W; uint16 is divided by the
/// camera's depth_factor. Throws InputError for others.
cv::Mat depth_image(const ImageArgument& array, double depth_factor);
/// Throws InputError where the sizes of colour and of depth (if it is not empty) are not the
/// camera's.
void require_size(const cv::Mat& color, const cv::Mat& depth, const Camera& camera);

/// Arrays that share the memory of the image, and keep it.
ColorArray color_array(const cv::Mat& image);
DepthArray depth_array(const cv::Mat& image);

/// N x D float32 or uint8 as a matrix that shares the memory; throws InputError for others.
cv::Mat descriptor_matrix(const ImageArgument& array);
nb::ndarray<nb::numpy, nb::ro, nb::ndim<2>> descriptor_array(const cv::Mat& descriptors);

/// Gives arrays back to Python that C++ needs no longer. Threads of C++ never wait for the GIL to
/// do so: they leave them for the next one who has it. With the GIL.
void release_arrays();

}  // namespace dxslam::python
