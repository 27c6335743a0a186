// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Levenberg-Marquardt for bundles. Points are eliminated one by one in blocks of fixed size, so
// that nothing is allocated or virtual in the inner loops; the poses are solved for densely, or
// sparsely where they are many (Triggs et al., Bundle Adjustment - A Modern Synthesis, section 6,
// 1999).
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/simd.h"
#include "optimization/bundle_engine.h"
#include "optimization/huber.h"
#include "optimization/sparse_blocks.h"

namespace dxslam {
namespace {

using Matrix63d = Eigen::Matrix<double, 6, 3>;

/// A column of six, padded to one AVX-512 register.
using Column = double __attribute__((vector_size(64), aligned(64)));
/// 6x3 and 6x6 blocks as such columns.
struct Block63 {
  Column column[3];
};
struct Block66 {
  Column column[6];
};

/// The six numbers of a column.
inline Eigen::Map<Vector6d> numbers(Column& column) {
  return Eigen::Map<Vector6d>(reinterpret_cast<double*>(&column));
}
inline Eigen::Map<const Vector6d> numbers(const Column& column) {
  return Eigen::Map<const Vector6d>(reinterpret_cast<const double*>(&column));
}

/// Place of block (a, b), a >= b, in a lower triangle of blocks.
inline std::size_t triangle(std::size_t a, std::size_t b) { return a * (a + 1) / 2 + b; }

/// target -= s t^T.
DXSLAM_INLINE_KERNEL void subtract_outer(const Block63& s, const Block63& t, Block66& target) {
  for (int c = 0; c < 6; ++c) {
    target.column[c] -=
        s.column[0] * t.column[0][c] + s.column[1] * t.column[1][c] + s.column[2] * t.column[2][c];
  }
}

/// Fill-in between all poses that see one point: for each pair of links the block of the lower
/// triangle, all of which there are. Links without a slot (negative) are of poses that are held.
DXSLAM_INLINE_KERNEL void couple(const int* slots, const Block63* scaled, int count,
                                 Block66* reduced) {
  for (int i = 0; i < count; ++i) {
    if (slots[i] < 0) continue;
    const auto a = static_cast<std::size_t>(slots[i]);
    for (int j = 0; j <= i; ++j) {
      if (slots[j] < 0) continue;
      const auto b = static_cast<std::size_t>(slots[j]);
      const std::size_t place = a < b ? triangle(b, a) : triangle(a, b);
      if (a >= b) subtract_outer(scaled[i], scaled[j], reduced[place]);
      // Both halves where one pose sees the point twice.
      if (a < b || (a == b && i != j)) subtract_outer(scaled[j], scaled[i], reduced[place]);
    }
  }
}

/// The part of it in column `column` of the triangle that one link of that pose, `own`, adds.
/// `places` tells by slot where the block in the column is; it has those of all that are coupled.
DXSLAM_INLINE_KERNEL void couple_column(int column, const Block63& own, const int* slots,
                                        const Block63* scaled, int count, const int* places,
                                        Block66* reduced) {
  for (int i = 0; i < count; ++i) {
    if (slots[i] >= column) subtract_outer(scaled[i], own, reduced[places[slots[i]]]);
  }
}

constexpr std::size_t kMostDensePoses = 1500;  // 650 MB
constexpr double kTinyDiagonal = 1e-9;         // keeps directions without any constraint solvable

/// An observation that takes part, laid out for the sweep over points.
struct Link {
  int pose = 0;
  int slot = -1;  ///< place among the free poses, -1 if held
  int observation = 0;
};

struct PointBlock {
  int point = 0;
  int first = 0;  ///< range of links
  int last = 0;
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();     ///< lower Cholesky factor L, damped hessian
  Eigen::Vector3d reduced = Eigen::Vector3d::Zero();  ///< L^-1 gradient
};

struct PoseBlock {
  int pose = 0;
  Matrix6d hessian = Matrix6d::Zero();  ///< lower triangle
  Vector6d gradient = Vector6d::Zero();
};

/// Lower Cholesky factor of a damped 3x3 block; false if that is not positive definite.
bool factorise(const Eigen::Matrix3d& a, double damping, Eigen::Matrix3d& l) {
  const Eigen::Vector3d d =
      a.diagonal() * (1.0 + damping) + Eigen::Vector3d::Constant(kTinyDiagonal);
  l.setZero();
  if (!(d(0) > 0.0)) return false;
  l(0, 0) = std::sqrt(d(0));
  l(1, 0) = a(1, 0) / l(0, 0);
  l(2, 0) = a(2, 0) / l(0, 0);
  const double d1 = d(1) - l(1, 0) * l(1, 0);
  if (!(d1 > 0.0)) return false;
  l(1, 1) = std::sqrt(d1);
  l(2, 1) = (a(2, 1) - l(2, 0) * l(1, 0)) / l(1, 1);
  const double d2 = d(2) - l(2, 0) * l(2, 0) - l(2, 1) * l(2, 1);
  if (!(d2 > 0.0)) return false;
  l(2, 2) = std::sqrt(d2);
  return true;
}

/// What descend() asks for.
class SchurSolver {
 public:
  SchurSolver(const BundleStage& stage, BundleState& state) : stage_(stage), state_(state) {
    collect_poses();
    collect_points();
    const auto size = static_cast<Eigen::Index>(6 * poses_.size());
    pose_step_.resize(size);
    cross_.resize(links_.size());
    scaled_.resize(links_.size(), Block63{});
    for (const Link& link : links_) link_slots_.push_back(link.slot);
    if (poses_.size() > static_cast<std::size_t>(stage.max_dense_poses)) find_couplings();
    if (!sparse_) {
      blocks_.resize(triangle(poses_.size(), 0));
      reduced_.resize(size, size);
    }
    rotations_.resize(state.camera_from_world.size());
  }

  double linearise() {
    update_rotations(state_);
    for (PoseBlock& block : poses_) {
      block.hessian.setZero();
      block.gradient.setZero();
    }
    double sum = 0.0;
    for (PointBlock& block : points_) {
      block.hessian.setZero();
      block.gradient.setZero();
      for (int k = block.first; k < block.last; ++k) {
        sum += linearise(block, static_cast<std::size_t>(k));
      }
    }
    return 0.5 * sum;
  }

  double propose(double damping) { return solve(damping) ? move(damping) : -1.0; }

  double trial_cost() {
    update_rotations(trial_);
    double sum = 0.0;
    double weight = 1.0;
    for (const PointBlock& block : points_) {
      const Eigen::Vector3d& point = trial_.points[static_cast<std::size_t>(block.point)];
      for (int k = block.first; k < block.last; ++k) {
        const Link& link = links_[static_cast<std::size_t>(k)];
        const BundleProblem::Observation& o = observation(link);
        const Eigen::Vector3d p = in_camera(trial_, link, point);
        sum +=
            kernel(o, bundle_residual(camera_of(*stage_.problem, o), o, p).squaredNorm(), weight);
      }
    }
    return 0.5 * sum;
  }

  void accept() { std::swap(state_, trial_); }

 private:
  void collect_poses() {
    slots_.assign(state_.camera_from_world.size(), -1);
    const auto& observations = stage_.problem->observations;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const auto pose = static_cast<std::size_t>(observations[i].pose);
      if (stage_.active[i] != 0 && stage_.held[pose] == 0) slots_[pose] = 0;
    }
    for (std::size_t pose = 0; pose < slots_.size(); ++pose) {
      if (slots_[pose] < 0) continue;
      slots_[pose] = static_cast<int>(poses_.size());
      poses_.emplace_back();
      poses_.back().pose = static_cast<int>(pose);
    }
  }

  /// Counting sort of the active observations by point.
  void collect_points() {
    const auto& observations = stage_.problem->observations;
    std::vector<int> start(state_.points.size() + 1, 0);
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (stage_.active[i] != 0) ++start[static_cast<std::size_t>(observations[i].point) + 1];
    }
    for (std::size_t p = 0; p + 1 < start.size(); ++p) {
      start[p + 1] += start[p];
      if (start[p + 1] > start[p]) {
        PointBlock block;
        block.point = static_cast<int>(p);
        block.first = start[p];
        block.last = start[p + 1];
        points_.push_back(block);
      }
    }
    links_.resize(static_cast<std::size_t>(start.back()));
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (stage_.active[i] == 0) continue;
      const BundleProblem::Observation& o = observations[i];
      links_[static_cast<std::size_t>(start[static_cast<std::size_t>(o.point)]++)] = {
          o.pose, slots_[static_cast<std::size_t>(o.pose)], static_cast<int>(i)};
    }
  }

  /// Counting sort of the links with a slot.
  void sort_links_by_pose() {
    starts_.assign(poses_.size() + 1, 0);
    for (const int slot : link_slots_) {
      if (slot >= 0) ++starts_[static_cast<std::size_t>(slot) + 1];
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    by_pose_.resize(static_cast<std::size_t>(starts_.back()));
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      for (int i = points_[p].first; i < points_[p].last; ++i) {
        const int slot = link_slots_[static_cast<std::size_t>(i)];
        if (slot < 0) continue;
        const int place = next[static_cast<std::size_t>(slot)]++;
        by_pose_[static_cast<std::size_t>(place)] = {i, static_cast<int>(p)};
      }
    }
  }

  /// Calls visit(link, block of its point) for the links of a slot.
  template <class Visit>
  void for_each_link(std::size_t slot, Visit&& visit) const {
    for (int i = starts_[slot]; i < starts_[slot + 1]; ++i) {
      const auto& [link, point] = by_pose_[static_cast<std::size_t>(i)];
      visit(link, points_[static_cast<std::size_t>(point)]);
    }
  }

  /// Which pairs of poses see a common point; unless they are so many that a dense system is solved
  /// faster, and not too many for its memory.
  void find_couplings() {
    sort_links_by_pose();
    std::vector<std::pair<int, int>> coupled;
    std::vector<int> met(poses_.size(), -1);  // the last slot that was found to be coupled with it
    for (int a = 0; a < static_cast<int>(poses_.size()); ++a) {
      for_each_link(static_cast<std::size_t>(a), [&](int, const PointBlock& block) {
        for (int i = block.first; i < block.last; ++i) {
          const int b = link_slots_[static_cast<std::size_t>(i)];
          if (b < 0 || b >= a || std::exchange(met[static_cast<std::size_t>(b)], a) == a) continue;
          coupled.emplace_back(a, b);
        }
      });
    }
    const double share =
        static_cast<double>(coupled.size()) / static_cast<double>(triangle(poses_.size(), 0));
    if (share > stage_.max_coupled_share && poses_.size() <= kMostDensePoses) return;
    sparse_.emplace(6, static_cast<int>(poses_.size()), std::move(coupled));
    blocks_.resize(static_cast<std::size_t>(sparse_->blocks()));
    places_.assign(poses_.size(), -1);
  }

  /// First of the six rows of a slot.
  template <class Slot>
  static Eigen::Index at(Slot slot) {
    return 6 * static_cast<Eigen::Index>(slot);
  }

  const BundleProblem::Observation& observation(const Link& link) const {
    return stage_.problem->observations[static_cast<std::size_t>(link.observation)];
  }

  void update_rotations(const BundleState& state) {
    for (std::size_t i = 0; i < rotations_.size(); ++i) {
      rotations_[i] = state.camera_from_world[i].rotation().toRotationMatrix();
    }
  }

  Eigen::Vector3d in_camera(const BundleState& state, const Link& link,
                            const Eigen::Vector3d& point) const {
    const auto pose = static_cast<std::size_t>(link.pose);
    return rotations_[pose] * point + state.camera_from_world[pose].translation();
  }

  double kernel(const BundleProblem::Observation& o, double error2, double& weight) const {
    weight = 1.0;
    return stage_.robust ? huber(error2, bundle_gate2(o, *stage_.options), weight) : error2;
  }

  double linearise(PointBlock& block, std::size_t k) {
    const Link& link = links_[k];
    const BundleProblem::Observation& o = observation(link);
    const Eigen::Vector3d p =
        in_camera(state_, link, state_.points[static_cast<std::size_t>(block.point)]);
    const Camera& camera = camera_of(*stage_.problem, o);
    const Eigen::Vector3d residual = bundle_residual(camera, o, p);
    double weight = 1.0;
    const double cost = kernel(o, residual.squaredNorm(), weight);

    // The information of the point in the camera frame carries over to pose and point alike.
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    if (p.z() > kMinProjectionDepth) {
      const double sigma = o.measured.sigma;
      point_information(camera, p, sigma * residual, weight / (sigma * sigma),
                        o.measured.has_disparity(), information, pull);
    }
    const Eigen::Matrix3d& rotation = rotations_[static_cast<std::size_t>(link.pose)];
    const Eigen::Matrix3d turned = information * rotation;
    block.hessian.noalias() += rotation.transpose() * turned;
    block.gradient.noalias() += rotation.transpose() * pull;
    if (link.slot < 0) return cost;

    PoseBlock& pose = poses_[static_cast<std::size_t>(link.slot)];
    add_left_perturbation(information, pull, p, pose.hessian, pose.gradient);
    cross_[k].topRows<3>() = turned;
    for (int c = 0; c < 3; ++c) cross_[k].col(c).tail<3>() = p.cross(turned.col(c));
    return cost;
  }

  /// Eliminates the points and solves for the poses. False if the system is not positive definite.
  bool solve(double damping) {
    std::fill(blocks_.begin(), blocks_.end(), Block66{});
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      Matrix6d diagonal = poses_[i].hessian.selfadjointView<Eigen::Lower>();
      diagonal.diagonal() +=
          damping * poses_[i].hessian.diagonal() + Vector6d::Constant(kTinyDiagonal);
      const int slot = static_cast<int>(i);
      Block66& block =
          blocks_[sparse_ ? static_cast<std::size_t>(sparse_->place(slot, slot)) : triangle(i, i)];
      for (int c = 0; c < 6; ++c) numbers(block.column[c]) = diagonal.col(c);
      pose_step_.segment<6>(at(i)) = -poses_[i].gradient;
    }
    for (PointBlock& block : points_) {
      if (!factorise(block.hessian, damping, block.root)) return false;
      eliminate(block);
    }
    if (sparse_) couple_sparsely();
    return poses_.empty() || solve_for_poses();
  }

  void eliminate(PointBlock& block) {
    const Eigen::Matrix3d& l = block.root;
    Eigen::Vector3d& y = block.reduced;
    y(0) = block.gradient(0) / l(0, 0);
    y(1) = (block.gradient(1) - l(1, 0) * y(0)) / l(1, 1);
    y(2) = (block.gradient(2) - l(2, 0) * y(0) - l(2, 1) * y(1)) / l(2, 2);
    for (int i = block.first; i < block.last; ++i) {
      const int slot = link_slots_[static_cast<std::size_t>(i)];
      if (slot < 0) continue;
      const Matrix63d& w = cross_[static_cast<std::size_t>(i)];
      Matrix63d s;  // w L^-T
      s.col(0) = w.col(0) / l(0, 0);
      s.col(1) = (w.col(1) - l(1, 0) * s.col(0)) / l(1, 1);
      s.col(2) = (w.col(2) - l(2, 0) * s.col(0) - l(2, 1) * s.col(1)) / l(2, 2);
      pose_step_.segment<6>(at(slot)) += s * y;
      Block63& scaled = scaled_[static_cast<std::size_t>(i)];
      for (int c = 0; c < 3; ++c) numbers(scaled.column[c]) = s.col(c);
    }
    if (sparse_) return;
    simd_kernel<couple>()(link_slots_.data() + block.first, scaled_.data() + block.first,
                          block.last - block.first, blocks_.data());
  }

  /// Column by column, since a table of all pairs of many poses would fill the memory.
  void couple_sparsely() {
    const auto couple_own = simd_kernel<couple_column>();
    int place = 0;
    for (int column = 0; column < static_cast<int>(poses_.size()); ++column) {
      for (; place < sparse_->blocks() && sparse_->column(place) == column; ++place) {
        places_[static_cast<std::size_t>(sparse_->row(place))] = place;
      }
      for_each_link(static_cast<std::size_t>(column), [&](int link, const PointBlock& block) {
        couple_own(column, scaled_[static_cast<std::size_t>(link)],
                   link_slots_.data() + block.first, scaled_.data() + block.first,
                   block.last - block.first, places_.data(), blocks_.data());
      });
    }
  }

  bool solve_for_poses() {
    if (sparse_) {
      for (int place = 0; place < sparse_->blocks(); ++place) {
        const Block66& block = blocks_[static_cast<std::size_t>(place)];
        SparseBlocks::Block target = sparse_->block(place);
        for (int c = 0; c < 6; ++c) target.col(c) = numbers(block.column[c]);
      }
      return sparse_->solve(pose_step_);
    }
    for (std::size_t a = 0; a < poses_.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const Block66& block = blocks_[triangle(a, b)];
        for (int c = 0; c < 6; ++c) {
          reduced_.col(at(b) + c).segment<6>(at(a)) = numbers(block.column[c]);
        }
      }
    }
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factor(reduced_);
    if (factor.info() != Eigen::Success) return false;
    factor.solveInPlace(pose_step_);
    return true;
  }

  /// Applies the step to a copy of the state; returns the decrease of cost the model predicts.
  double move(double damping) {
    trial_ = state_;
    double predicted = 0.0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const Vector6d step = pose_step_.segment<6>(at(i));
      const PoseBlock& block = poses_[i];
      predicted +=
          damping * step.cwiseAbs2().dot(block.hessian.diagonal()) - step.dot(block.gradient);
      SE3& pose = trial_.camera_from_world[static_cast<std::size_t>(block.pose)];
      pose = SE3::exp(step) * pose;
    }
    for (const PointBlock& block : points_) {
      const Eigen::Vector3d step = point_step(block);
      predicted +=
          damping * step.cwiseAbs2().dot(block.hessian.diagonal()) - step.dot(block.gradient);
      trial_.points[static_cast<std::size_t>(block.point)] += step;
    }
    return 0.5 * predicted;
  }

  Eigen::Vector3d point_step(const PointBlock& block) const {
    Eigen::Vector3d y = -block.reduced;
    for (int k = block.first; k < block.last; ++k) {
      const int slot = links_[static_cast<std::size_t>(k)].slot;
      if (slot < 0) continue;
      const Block63& scaled = scaled_[static_cast<std::size_t>(k)];
      for (int c = 0; c < 3; ++c) {
        y(c) -= numbers(scaled.column[c]).dot(pose_step_.segment<6>(at(slot)));
      }
    }
    const Eigen::Matrix3d& l = block.root;
    Eigen::Vector3d step;
    step(2) = y(2) / l(2, 2);
    step(1) = (y(1) - l(2, 1) * step(2)) / l(1, 1);
    step(0) = (y(0) - l(1, 0) * step(1) - l(2, 0) * step(2)) / l(0, 0);
    return step;
  }

  const BundleStage& stage_;
  BundleState& state_;
  BundleState trial_;
  std::vector<int> slots_;  ///< one per pose: place among the free ones that are seen, or -1
  std::vector<PoseBlock> poses_;
  std::vector<PointBlock> points_;
  std::vector<Link> links_;       ///< by point
  std::vector<Matrix63d> cross_;  ///< pose-point blocks of the hessian, one per link
  std::vector<Block63> scaled_;   ///< the same times L^-T of the point
  std::vector<int> link_slots_;   ///< slots of the links
  std::vector<Eigen::Matrix3d> rotations_;
  std::vector<Block66> blocks_;               ///< camera system after the elimination
  std::optional<SparseBlocks> sparse_;        ///< the same as one matrix, if poses are many
  std::vector<std::pair<int, int>> by_pose_;  ///< links and their points; if poses are many
  std::vector<int> starts_;                   ///< one per slot and one more: range in by_pose_
  std::vector<int> places_;                   ///< in a column, by slot
  Eigen::MatrixXd reduced_;                   ///< the same as one matrix if not, lower triangle
  Eigen::VectorXd pose_step_;
};

}  // namespace

DescentReport minimise_bundle(const BundleStage& stage, BundleState& state) {
  SchurSolver solver(stage, state);
  return descend(solver, stage.iterations, stage.options->min_decrease, stage.may_go_on);
}

}  // namespace dxslam
