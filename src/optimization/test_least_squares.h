// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <utility>

namespace dxslam {

/// Residuals as a function of the unknowns; sets all of the second argument.
using ResidualFunction = std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>;

/// The form that Eigen's MINPACK wants.
struct ResidualFunctor {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  ResidualFunction residuals;
  Eigen::Index unknowns = 0;
  Eigen::Index count = 0;

  int inputs() const { return static_cast<int>(unknowns); }
  int values() const { return static_cast<int>(count); }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
    // Unknowns are deltas near zero, where MINPACK's relative step of differences would vanish.
    residuals(x - Eigen::VectorXd::Ones(x.size()), r);
    return 0;
  }
};

using DifferencedResiduals = Eigen::NumericalDiff<ResidualFunctor, Eigen::Central>;

/// An oracle for our own solvers that shares nothing with them: least squares by MINPACK, with
/// derivatives by central differences. Starts at zero; returns the unknowns at the minimum.
inline Eigen::VectorXd minimise_by_minpack(Eigen::Index unknowns, Eigen::Index count,
                                           ResidualFunction residuals) {
  ResidualFunctor functor;
  functor.residuals = std::move(residuals);
  functor.unknowns = unknowns;
  functor.count = count;
  DifferencedResiduals differenced(functor);
  Eigen::LevenbergMarquardt<DifferencedResiduals> solver(differenced);
  solver.parameters.xtol = solver.parameters.ftol = 1e-14;
  solver.parameters.maxfev = 2000;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(unknowns);
  solver.minimize(x);
  return x - Eigen::VectorXd::Ones(unknowns);
}

/// Derivative of the residuals at zero, by central differences.
inline Eigen::MatrixXd jacobian_by_differences(Eigen::Index unknowns, Eigen::Index count,
                                               const ResidualFunction& residuals) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(count, unknowns);
  Eigen::VectorXd ahead(count);
  Eigen::VectorXd behind(count);
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const Eigen::VectorXd delta = kStep * Eigen::VectorXd::Unit(unknowns, k);
    residuals(delta, ahead);
    residuals(-delta, behind);
    jacobian.col(k) = (ahead - behind) / (2.0 * kStep);
  }
  return jacobian;
}

/// By what to scale a residual so that its square is its cost under the Huber kernel.
inline double huber_scale(double error2, double width2) {
  if (error2 <= width2) return 1.0;
  return std::sqrt((2.0 * std::sqrt(width2 * error2) - width2) / error2);
}

}  // namespace dxslam
