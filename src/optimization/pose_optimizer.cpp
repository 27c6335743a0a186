// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/pose_optimizer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/reprojection.h"

namespace dxslam {
namespace {

constexpr double kInitialDamping = 1e-5;  // share of the diagonal of the normal equations
constexpr double kMaxDamping = 1e6;       // beyond it no step can help any more
constexpr double kSmallStep2 = 1e-16;     // squared norm of a step in metres and radians
constexpr double kSmallDecrease = 1e-6;   // share of the cost

/// Normal equations and cost of all observations in use.
struct System {
  Matrix6d hessian;  // lower triangle
  Vector6d gradient;
  double cost = 0.0;
};

class Problem {
 public:
  Problem(const Camera& camera, const std::vector<PoseObservation>& observations,
          const PoseOptimizerOptions& options)
      : camera_(camera), observations_(observations), options_(options) {}

  static bool usable(const PoseObservation& o) {
    return o.point_in_world.allFinite() && o.measured.is_finite();
  }

  double gate(const PoseObservation& o) const {
    return o.measured.has_disparity() ? options_.chi2_depth : options_.chi2_pixel;
  }

  Eigen::Vector3d residual(const PoseObservation& o, const Eigen::Vector3d& point) const {
    return stereo_residual(camera_, o.measured, point);
  }

  /// Builds the normal equations of the observations whose mask is set.
  void linearise(const SE3& camera_from_world, const std::vector<char>& mask, bool robust,
                 System& system) const {
    const Eigen::Matrix3d rotation = camera_from_world.rotation().toRotationMatrix();
    system.hessian.setZero();
    system.gradient.setZero();
    system.cost = 0.0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (mask[i] != 0) {
        add(rotation, camera_from_world.translation(), observations_[i], robust, system);
      }
    }
  }

  /// Sets the mask by the gates and returns the number of inliers.
  int classify(const SE3& camera_from_world, std::vector<char>& mask) const {
    int inliers = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const PoseObservation& o = observations_[i];
      const Eigen::Vector3d point = camera_from_world * o.point_in_world;
      const bool good =
          usable(o) && point.z() > kMinProjectionDepth &&
          residual(o, point).squaredNorm() <= gate(o) * o.measured.sigma * o.measured.sigma;
      mask[i] = good ? 1 : 0;
      inliers += mask[i];
    }
    return inliers;
  }

  void select_usable(std::vector<char>& mask) const {
    std::transform(observations_.begin(), observations_.end(), mask.begin(),
                   [](const PoseObservation& o) { return static_cast<char>(usable(o)); });
  }

  /// Numbers measured by the observations in the mask.
  int residuals(const std::vector<char>& mask) const {
    int sum = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (mask[i] != 0) sum += observations_[i].measured.has_disparity() ? 3 : 2;
    }
    return sum;
  }

  double rms_pixels(const SE3& camera_from_world, const std::vector<char>& mask,
                    int inliers) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (mask[i] == 0) continue;
      const PoseObservation& o = observations_[i];
      sum += residual(o, camera_from_world * o.point_in_world).head<2>().squaredNorm();
    }
    return inliers > 0 ? std::sqrt(sum / inliers) : 0.0;
  }

 private:
  void add(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
           const PoseObservation& o, bool robust, System& system) const {
    const Eigen::Vector3d point = rotation * o.point_in_world + translation;
    const double information = 1.0 / (o.measured.sigma * o.measured.sigma);
    const double delta2 = gate(o);
    if (!(point.z() > kMinProjectionDepth)) {
      // No projection: a constant cost, as of a residual across the image, and no pull.
      const double width2 = static_cast<double>(camera_.width) * camera_.width * information;
      system.cost += robust ? 2.0 * std::sqrt(delta2 * width2) - delta2 : width2;
      return;
    }
    const Eigen::Vector3d r = residual(o, point);
    const double error2 = r.squaredNorm() * information;
    double weight = information;
    if (robust && error2 > delta2) {
      const double ratio = std::sqrt(delta2 / error2);
      weight *= ratio;
      system.cost += 2.0 * ratio * error2 - delta2;
    } else {
      system.cost += error2;
    }
    Eigen::Matrix3d by_point;
    Eigen::Vector3d pull;
    point_information(camera_, point, r, weight, o.measured.has_disparity(), by_point, pull);
    add_left_perturbation(by_point, pull, point, system.hessian, system.gradient);
  }

  const Camera& camera_;
  const std::vector<PoseObservation>& observations_;
  const PoseOptimizerOptions& options_;
};

/// Levenberg-Marquardt; each step costs one pass over the observations. Damping falls threefold
/// after a step that helped and rises ever faster after ones that did not (Nielsen 1999).
void minimise(const Problem& problem, const std::vector<char>& mask, bool robust, int iterations,
              SE3& camera_from_world) {
  System current;
  System trial;
  problem.linearise(camera_from_world, mask, robust, current);
  double damping = kInitialDamping;
  double growth = 2.0;
  for (int i = 0; i < iterations && damping < kMaxDamping; ++i) {
    Matrix6d damped = current.hessian;
    damped.diagonal() += damping * current.hessian.diagonal();
    const Vector6d step = damped.selfadjointView<Eigen::Lower>().ldlt().solve(-current.gradient);
    if (!step.allFinite()) return;
    const SE3 candidate = SE3::exp(step) * camera_from_world;
    problem.linearise(candidate, mask, robust, trial);
    if (trial.cost < current.cost) {
      const bool converged = current.cost - trial.cost < kSmallDecrease * current.cost;
      camera_from_world = candidate;
      current = trial;
      damping /= 3.0;
      growth = 2.0;
      if (converged || step.squaredNorm() < kSmallStep2) return;
    } else {
      if (step.squaredNorm() < kSmallStep2) return;
      damping *= growth;
      growth *= 2.0;
    }
  }
}

bool finite(const SE3& pose) {
  return pose.rotation().coeffs().allFinite() && pose.translation().allFinite();
}

}  // namespace

PoseReport optimize_pose(const Camera& camera, const SE3& world_from_camera,
                         const std::vector<PoseObservation>& observations,
                         const PoseOptimizerOptions& options) {
  PoseReport report;
  report.world_from_camera = world_from_camera;
  report.inlier.assign(observations.size(), 0);
  if (!finite(world_from_camera)) return report;

  const Problem problem(camera, observations, options);
  SE3 camera_from_world = world_from_camera.inverse();
  std::vector<char>& mask = report.inlier;
  for (int round = 0; round < options.rounds; ++round) {
    const bool last = round + 1 == options.rounds;
    // With too few inliers to hold the pose, all observations vote again under the kernel.
    const bool robust = round == 0 || report.inliers < options.min_inliers || !last;
    if (report.inliers < options.min_inliers) problem.select_usable(mask);
    minimise(problem, mask, robust, options.iterations, camera_from_world);
    report.inliers = problem.classify(camera_from_world, mask);
  }
  if (report.inliers < options.min_inliers || !finite(camera_from_world)) return report;

  System system;
  problem.linearise(camera_from_world, mask, false, system);
  report.information = system.hessian.selfadjointView<Eigen::Lower>();
  const int degrees = problem.residuals(mask) - 6;
  if (degrees > 0) report.variance_factor = system.cost / degrees;
  report.rms_pixels = problem.rms_pixels(camera_from_world, mask, report.inliers);
  report.world_from_camera = camera_from_world.inverse();
  report.success = true;
  return report;
}

// exp(e) on the left of camera_from_world is exp(-e) on the right of its inverse.
std::optional<Matrix6d> pose_covariance(const Matrix6d& information, double variance_factor) {
  const Eigen::LLT<Matrix6d> factors(information);
  if (factors.info() != Eigen::Success) return std::nullopt;
  const Matrix6d inverse = factors.solve(Matrix6d::Identity());
  const Matrix6d covariance = 0.5 * variance_factor * (inverse + inverse.transpose());
  const bool usable = covariance.allFinite() && (covariance.diagonal().array() > 0.0).all();
  return usable ? std::optional<Matrix6d>(covariance) : std::nullopt;
}

}  // namespace dxslam
