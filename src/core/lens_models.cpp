// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <Eigen/LU>

#include "core/lens.h"

namespace dxslam {

const std::vector<const LensModel*>& lens_models() {
  static const std::vector<const LensModel*> models = {&kRadialTangential, &kRational,
                                                       &kKannalaBrandt, &kDoubleSphere};
  return models;
}

const LensModel* find_lens_model(const std::string& name) {
  for (const LensModel* model : lens_models()) {
    if (name == model->name) return model;
  }
  return nullptr;
}

std::optional<Eigen::Vector2d> undistort_by_newton(const LensModel& model,
                                                   const Lens::Parameters& parameters,
                                                   const Eigen::Vector2d& distorted) {
  Eigen::Vector2d x = distorted;
  Eigen::Matrix2d jacobian;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d residual = distorted - model.distort(parameters, x, &jacobian);
    const Eigen::Vector2d step = jacobian.inverse() * residual;
    x += step;
    if (step.squaredNorm() < 1e-20) break;
  }
  if (!x.allFinite()) return std::nullopt;
  return x;
}

}  // namespace dxslam
