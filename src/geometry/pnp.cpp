// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/pnp.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "geometry/p3p.h"
#include "geometry/reprojection.h"

namespace dxslam {
namespace {

using Sample = std::array<std::size_t, 3>;

constexpr double kDepthTolerance = 0.1;  // share of the depth, see the header
constexpr int kLocalSteps = 4;           // Gauss-Newton steps of a local optimisation
constexpr int kFinalRounds = 5;

class PnpRansac {
 public:
  PnpRansac(const Camera& camera, const std::vector<Eigen::Vector3d>& points,
            const std::vector<Eigen::Vector2d>& pixels, const std::vector<float>& depths,
            const PnpOptions& options)
      : camera_(camera),
        points_(points),
        pixels_(pixels),
        options_(options),
        random_(static_cast<std::uint32_t>(options.seed)) {
    depths_.assign(points.size(), 0.0);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      if (depths[i] > 0.0F && std::isfinite(depths[i])) depths_[i] = static_cast<double>(depths[i]);
    }
    rays_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      rays_.push_back(camera.unproject(pixels[i], 1.0));
      const double threshold = options.threshold * camera.stretch(pixels[i]);
      thresholds2_.push_back(threshold * threshold);
      if (points[i].allFinite() && pixels[i].allFinite()) usable_.push_back(i);
    }
    mask_.assign(points.size(), 0);
  }

  std::optional<PnpReport> run() {
    if (static_cast<int>(usable_.size()) < std::max(4, options_.min_inliers)) return std::nullopt;
    best_.score = static_cast<double>(usable_.size());
    int needed = options_.iterations;
    for (int i = 0; i < needed; ++i) {
      const double before = best_.score;
      try_sample(draw());
      if (best_.score < before) {
        improve();
        needed = std::min(options_.iterations, samples_needed());
      }
    }
    if (best_.inliers < 3) return std::nullopt;
    return finish();
  }

 private:
  struct Hypothesis {
    SE3 camera_from_world;
    double score = 0.0;  ///< sum of truncated errors, 0 to the number of correspondences
    int inliers = 0;
  };

  Sample draw() {
    Sample sample{};
    for (std::size_t k = 0; k < 3; ++k) {
      bool fresh = false;
      while (!fresh) {
        // Own mapping to an index: the distributions of the standard library differ by vendor.
        sample[k] = usable_[(static_cast<std::uint64_t>(random_()) * usable_.size()) >> 32U];
        fresh = std::find(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(k),
                          sample[k]) == sample.begin() + static_cast<std::ptrdiff_t>(k);
      }
    }
    return sample;
  }

  void try_sample(const Sample& sample) {
    const std::array<Eigen::Vector3d, 3> world = {points_[sample[0]], points_[sample[1]],
                                                  points_[sample[2]]};
    const std::array<Eigen::Vector3d, 3> rays = {rays_[sample[0]], rays_[sample[1]],
                                                 rays_[sample[2]]};
    if (!spans_plane(world)) return;
    const std::array<double, 3> depth = {depths_[sample[0]], depths_[sample[1]],
                                         depths_[sample[2]]};
    const bool measured = depth[0] > 0.0 && depth[1] > 0.0 && depth[2] > 0.0;
    if (measured) {
      const std::array<Eigen::Vector3d, 3> in_camera = {depth[0] * rays[0], depth[1] * rays[1],
                                                        depth[2] * rays[2]};
      // A rigid scene keeps lengths: most contaminated samples end here, for next to nothing.
      if (!sides_agree(world, in_camera, depth)) return;
      if (spans_plane(in_camera)) offer(align_triangles(world, in_camera));
    }
    const P3pSolutions solutions = solve_p3p(world, rays);
    for (int i = 0; i < solutions.count; ++i) {
      offer(solutions.camera_from_world[static_cast<std::size_t>(i)]);
    }
  }

  static bool sides_agree(const std::array<Eigen::Vector3d, 3>& a,
                          const std::array<Eigen::Vector3d, 3>& b,
                          const std::array<double, 3>& depth) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double difference = (a[i] - a[j]).norm() - (b[i] - b[j]).norm();
      if (!(std::abs(difference) <= kDepthTolerance * (depth[i] + depth[j]))) return false;
    }
    return true;
  }

  /// Squared error over squared threshold; at least 1 for an outlier.
  double error(const Eigen::Vector3d& in_camera, std::size_t i) const {
    if (!(in_camera.z() > kMinProjectionDepth)) return 1.0;
    if (depths_[i] > 0.0 &&
        !(std::abs(in_camera.z() - depths_[i]) <= kDepthTolerance * depths_[i])) {
      return 1.0;
    }
    return (camera_.project(in_camera) - pixels_[i]).squaredNorm() / thresholds2_[i];
  }

  void offer(const SE3& camera_from_world) {
    const Eigen::Matrix3d rotation = camera_from_world.rotation().toRotationMatrix();
    Hypothesis hypothesis{camera_from_world, 0.0, 0};
    for (const std::size_t i : usable_) {
      const double e = error(rotation * points_[i] + camera_from_world.translation(), i);
      if (e < 1.0) {
        hypothesis.score += e;
        ++hypothesis.inliers;
      } else {
        hypothesis.score += 1.0;
        if (hypothesis.score >= best_.score) return;
      }
    }
    if (hypothesis.score < best_.score) best_ = hypothesis;
  }

  int mark_inliers(const SE3& camera_from_world) {
    int inliers = 0;
    std::fill(mask_.begin(), mask_.end(), 0);
    for (const std::size_t i : usable_) {
      if (error(camera_from_world * points_[i], i) < 1.0) {
        mask_[i] = 1;
        ++inliers;
      }
    }
    return inliers;
  }

  /// One Gauss-Newton step of the reprojection error over the marked points. False if it fails.
  bool step(SE3& camera_from_world) const {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const std::size_t i : usable_) {
      if (mask_[i] == 0) continue;
      const Eigen::Vector3d p = camera_from_world * points_[i];
      if (!(p.z() > kMinProjectionDepth)) continue;
      const Eigen::Matrix<double, 2, 3> by_point = project_stereo_jacobian(camera_, p).topRows<2>();
      const Eigen::Matrix<double, 2, 6> jacobian = left_perturbation_jacobian<2>(by_point, p);
      hessian.noalias() += jacobian.transpose() * jacobian;
      gradient.noalias() += jacobian.transpose() * (camera_.project(p) - pixels_[i]);
    }
    // A whisper of damping keeps three-point sets solvable and changes nothing else.
    hessian.diagonal() *= 1.0 + 1e-9;
    const Vector6d delta = hessian.ldlt().solve(-gradient);
    if (!delta.allFinite()) return false;
    camera_from_world = SE3::exp(delta) * camera_from_world;
    return true;
  }

  /// Local optimisation: fits the best hypothesis to its inliers while that helps.
  void improve() {
    for (int round = 0; round < kFinalRounds; ++round) {
      const double before = best_.score;
      SE3 pose = best_.camera_from_world;
      if (mark_inliers(pose) < 4) return;
      for (int i = 0; i < kLocalSteps; ++i) {
        if (!step(pose)) return;
      }
      offer(pose);
      if (!(best_.score < before)) return;
    }
  }

  int samples_needed() const {
    const double share = static_cast<double>(best_.inliers) / static_cast<double>(usable_.size());
    const double clean = share * share * share;
    if (clean >= 1.0) return 1;
    const double needed = std::ceil(std::log(1.0 - options_.confidence) / std::log1p(-clean));
    return needed < options_.iterations ? static_cast<int>(needed) : options_.iterations;
  }

  std::optional<PnpReport> finish() {
    PnpReport report;
    report.inliers = mark_inliers(best_.camera_from_world);
    if (report.inliers < options_.min_inliers) return std::nullopt;
    report.inlier = mask_;
    report.world_from_camera = best_.camera_from_world.inverse();
    return report;
  }

  const Camera& camera_;
  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<Eigen::Vector2d>& pixels_;
  const PnpOptions& options_;
  std::vector<double> thresholds2_;  // as long as the lens makes them there
  std::mt19937 random_;
  std::vector<double> depths_;
  std::vector<Eigen::Vector3d> rays_;  ///< z = 1
  std::vector<std::size_t> usable_;    ///< finite correspondences
  std::vector<char> mask_;
  Hypothesis best_;
};

}  // namespace

std::optional<PnpReport> solve_pnp(const Camera& camera,
                                   const std::vector<Eigen::Vector3d>& points_in_world,
                                   const std::vector<Eigen::Vector2d>& pixels,
                                   const std::vector<float>& depths, const PnpOptions& options) {
  require(pixels.size() == points_in_world.size(), "solve_pnp needs as many pixels as points");
  require(depths.empty() || depths.size() == points_in_world.size(),
          "solve_pnp needs one depth a point or none at all");
  return PnpRansac(camera, points_in_world, pixels, depths, options).run();
}

}  // namespace dxslam
