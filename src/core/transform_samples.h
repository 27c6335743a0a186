// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/se3.h"
#include "core/sim3.h"

namespace dxslam {

/// Random numbers that are the same with every standard library; for tests and benchmarks.
class SampleSource {
 public:
  explicit SampleSource(std::uint32_t seed) : random_(seed) {}

  double uniform(double from, double to) { return from + (to - from) * random_() / 4294967296.0; }
  /// Mean 0, standard deviation 1; a sum of uniform numbers, so never beyond 6.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
    return sum;
  }
  Eigen::Vector3d vector(double extent) {
    const double x = uniform(-extent, extent);
    const double y = uniform(-extent, extent);
    return {x, y, uniform(-extent, extent)};
  }
  /// Any direction, the given length.
  Eigen::Vector3d direction(double length) {
    Eigen::Vector3d v = vector(1.0);
    while (v.norm() < 0.1) v = vector(1.0);
    return length * v.normalized();
  }
  Vector6d tangent(double extent) {
    Vector6d v;
    v.head<3>() = vector(extent);
    v.tail<3>() = vector(extent);
    return v;
  }

 private:
  std::mt19937 random_;
};

/// Rotation vectors where the formulas of the exponential map change or lose digits: zero, tiny,
/// about the switch to series, ordinary, and close to pi.
inline std::vector<Eigen::Vector3d> sample_rotation_vectors() {
  SampleSource source(11);
  std::vector<Eigen::Vector3d> samples = {Eigen::Vector3d::Zero()};
  for (const double angle : {1e-12, 1e-8, 0.99e-4, 1.01e-4, 0.99e-3, 1.01e-3, 0.05, 0.2, 1.0, 2.0,
                             3.0, M_PI - 1e-4, M_PI - 1e-8}) {
    for (int i = 0; i < 3; ++i) samples.push_back(source.direction(angle));
  }
  return samples;
}

inline std::vector<SE3> sample_poses() {
  SampleSource source(12);
  std::vector<SE3> samples = {SE3()};
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    samples.emplace_back(so3_exp(phi), source.vector(2.0));
  }
  return samples;
}

inline std::vector<Sim3> sample_similarities() {
  SampleSource source(13);
  std::vector<Sim3> samples = {Sim3()};
  const double log_scales[] = {0.0, 1e-9, -1e-5, 0.05, -0.3, 1.5};
  std::size_t k = 0;
  for (const Eigen::Vector3d& phi : sample_rotation_vectors()) {
    samples.emplace_back(std::exp(log_scales[k++ % 6]), so3_exp(phi), source.vector(2.0));
  }
  return samples;
}

}  // namespace dxslam
