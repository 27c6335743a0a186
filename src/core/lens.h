// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace dxslam {

struct LensModel;

/// A lens: a model and its parameters. Without distortion by default. Plain data.
struct Lens {
  static constexpr std::size_t kMaxParameters = 8;
  using Parameters = std::array<double, kMaxParameters>;

  const LensModel* model = &default_model();
  Parameters parameters{};  ///< in the order of LensModel::parameters; the rest is 0

  /// Whether it maps straight lines to straight lines, so that nothing is to be undone.
  bool is_ideal() const;
  bool operator==(const Lens& other) const {
    return model == other.model && parameters == other.parameters;
  }
  bool operator!=(const Lens& other) const { return !(*this == other); }

  static const LensModel& default_model();
};

/// How a family of lenses bends light. Positions are on the plane at unit focal length: `ideal` is
/// (x / z, y / z) of a point in the camera frame, `distorted` where the image has it, in focal
/// lengths from the principal point. A new model is one file of such functions and a row in the
/// table of lens_models.cpp.
struct LensModel {
  const char* name;  ///< in calibration and map files
  /// Names of the parameters in calibration files, then nulls; all are dimensionless.
  std::array<const char*, Lens::kMaxParameters> parameters;
  bool ideal_at_zero;             ///< no distortion where all parameters are 0
  bool is_fisheye;                ///< parts of its image may show what is beside or behind it
  const char* colmap_name;        ///< of the same model there; null if there is none
  std::size_t colmap_parameters;  ///< how many it has there; those ours lacks are 0

  /// `jacobian`, if given, receives the derivative by `ideal`.
  Eigen::Vector2d (*distort)(const Lens::Parameters& parameters, const Eigen::Vector2d& ideal,
                             Eigen::Matrix2d* jacobian);
  /// Empty where no direction in front of the camera appears.
  std::optional<Eigen::Vector2d> (*undistort)(const Lens::Parameters& parameters,
                                              const Eigen::Vector2d& distorted);

  std::size_t parameter_count() const {
    std::size_t n = 0;
    while (n < parameters.size() && parameters[n] != nullptr) ++n;
    return n;
  }
};

// One file each: lens_*.cpp.
extern const LensModel kRadialTangential;  ///< k1 k2 p1 p2 k3: OpenCV, TUM; "plumb_bob" in ROS
extern const LensModel kRational;       ///< k1 k2 p1 p2 k3 k4 k5 k6: OpenCV, "rational_polynomial"
extern const LensModel kKannalaBrandt;  ///< k1 k2 k3 k4: fisheye of OpenCV, "equidistant"
extern const LensModel kDoubleSphere;   ///< xi alpha (Usenko, Demmel, Cremers 2018): fisheye

/// All models.
const std::vector<const LensModel*>& lens_models();
/// Null for a name that none has.
const LensModel* find_lens_model(const std::string& name);

inline const LensModel& Lens::default_model() { return kRadialTangential; }

inline bool Lens::is_ideal() const {
  if (!model->ideal_at_zero) return false;
  for (const double p : parameters) {
    if (p != 0.0) return false;
  }
  return true;
}

/// Undoes a model's distort() by Newton's method from `distorted` on; for lenses that bend little.
std::optional<Eigen::Vector2d> undistort_by_newton(const LensModel& model,
                                                   const Lens::Parameters& parameters,
                                                   const Eigen::Vector2d& distorted);

}  // namespace dxslam
