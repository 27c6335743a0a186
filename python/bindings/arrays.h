// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <type_traits>
#include <vector>

#include "core/se3.h"

namespace dxslam::python {

namespace nb = nanobind;

/// A NumPy array of its own, with its shape in the stub; -1: any.
template <class T, nb::ssize_t... Shape>
using Array = nb::ndarray<nb::numpy, T, nb::shape<Shape...>>;
/// An argument that is read, and converted where that is needed.
template <class T, nb::ssize_t... Shape>
using ArrayArgument = nb::ndarray<const T, nb::shape<Shape...>, nb::c_contig, nb::device::cpu>;

/// For properties that give arrays of their own: the object need not live as long.
inline constexpr auto kOwned = nb::rv_policy::automatic;

/// Hands the numbers, row by row, to Python.
template <class A>
A to_array(std::vector<std::remove_const_t<typename A::Scalar>> numbers,
           std::initializer_list<std::size_t> shape) {
  using Numbers = std::vector<std::remove_const_t<typename A::Scalar>>;
  auto* kept = new Numbers(std::move(numbers));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<Numbers*>(p); });
  return A(kept->data(), shape, owner);
}

/// One row per item.
template <class A, class Items, class RowOf>
A rows_array(const Items& items, std::size_t columns, const RowOf& row_of) {
  std::vector<std::remove_const_t<typename A::Scalar>> numbers;
  numbers.reserve(items.size() * columns);
  for (const auto& item : items) {
    for (const auto& number : row_of(item)) numbers.push_back(number);
  }
  return to_array<A>(std::move(numbers), {items.size(), columns});
}

/// One number per item.
template <class T, class Items, class NumberOf>
Array<T, -1> column_array(const Items& items, const NumberOf& number_of) {
  std::vector<T> numbers;
  numbers.reserve(items.size());
  for (const auto& item : items) numbers.push_back(static_cast<T>(number_of(item)));
  return to_array<Array<T, -1>>(std::move(numbers), {items.size()});
}

using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

inline Array<double, 4, 4> to_array(const RowMajor4& matrix) {
  return to_array<Array<double, 4, 4>>(std::vector<double>(matrix.data(), matrix.data() + 16),
                                       {4, 4});
}
inline Array<double, 4, 4> to_array(const SE3& pose) { return to_array(RowMajor4(pose.matrix())); }
inline Array<double, 6, 6> to_array(const Matrix6d& symmetric) {
  return to_array<Array<double, 6, 6>>(
      std::vector<double>(symmetric.data(), symmetric.data() + symmetric.size()), {6, 6});
}
inline Array<double, 3> to_array(const Eigen::Vector3d& v) {
  return to_array<Array<double, 3>>({v.x(), v.y(), v.z()}, {3});
}

/// One pose per item, N x 4 x 4.
template <class Items, class PoseOf>
Array<double, -1, 4, 4> poses_array(const Items& items, const PoseOf& pose_of) {
  std::vector<double> numbers;
  numbers.reserve(items.size() * 16);
  for (const auto& item : items) {
    const RowMajor4 matrix = pose_of(item).matrix();
    numbers.insert(numbers.end(), matrix.data(), matrix.data() + 16);
  }
  return to_array<Array<double, -1, 4, 4>>(std::move(numbers), {items.size(), 4, 4});
}

}  // namespace dxslam::python
