// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/trajectory.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/interruptible.h"
#include "core/error.h"
#include "core/pose_numbers.h"
#include "io/formats/trajectory_file.h"
#include "io/formats/trajectory_reader.h"

namespace dxslam::python {
namespace {

using TumRows = Array<double, -1, 8>;

constexpr double kRounding = 1e-3;  // of what should be of unit length

[[noreturn]] void refuse(std::size_t row, const char* what) {
  throw InputError(fmt::format("pose {} of the trajectory has {}", row, what));
}

void append(Trajectory& poses, std::size_t row, double stamp, const SE3& pose) {
  if (!std::isfinite(stamp) || (!poses.empty() && stamp <= poses.back().stamp)) {
    refuse(row, "a stamp that is not later than the one before, expected rising stamps, seconds");
  }
  poses.push_back({stamp, pose});
}

Trajectory of_matrices(const ArrayArgument<double, -1>& stamps,
                       const ArrayArgument<double, -1, 4, 4>& matrices) {
  if (stamps.shape(0) != matrices.shape(0)) {
    throw InputError(fmt::format("the trajectory has {} stamps and {} poses, expected as many",
                                 stamps.shape(0), matrices.shape(0)));
  }
  Trajectory poses;
  poses.reserve(stamps.shape(0));
  for (std::size_t i = 0; i < stamps.shape(0); ++i) {
    const Eigen::Matrix4d matrix = Eigen::Map<const RowMajor4>(matrices.data() + 16 * i);
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    const bool is_rigid =
        matrix.allFinite() && matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)) &&
        (rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), kRounding) &&
        rotation.determinant() > 0.0;
    if (!is_rigid) refuse(i, "no rigid motion, expected [R t; 0 0 0 1] with a rotation R");
    append(poses, i, stamps.data()[i], SE3(matrix));
  }
  return poses;
}

Trajectory of_tum(const ArrayArgument<double, -1, 8>& rows) {
  Trajectory poses;
  poses.reserve(rows.shape(0));
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const double* r = rows.data() + 8 * i;
    const Eigen::Quaterniond q(r[7], r[4], r[5], r[6]);
    const Eigen::Vector3d t(r[1], r[2], r[3]);
    if (!t.allFinite() || !(std::abs(q.norm() - 1.0) < kRounding)) {
      refuse(i, "no finite position and unit quaternion, expected stamp tx ty tz qx qy qz qw");
    }
    append(poses, i, r[0], SE3(q, t));
  }
  return poses;
}

TumRows to_tum(const Trajectory& poses) {
  return rows_array<TumRows>(poses, 8, [](const StampedPose& p) {
    const PoseNumbers n = numbers_of(p.world_from_camera);
    return std::array<double, 8>{p.stamp, n[4], n[5], n[6], n[0], n[1], n[2], n[3]};
  });
}

void bind_making(nb::class_<Trajectory>& trajectory) {
  trajectory
      .def(
          "__init__",
          [](Trajectory* self, const ArrayArgument<double, -1>& stamps,
             const ArrayArgument<double, -1, 4, 4>& matrices) {
            new (self) Trajectory(of_matrices(stamps, matrices));
          },
          nb::arg("stamps"), nb::arg("world_from_camera"),
          "Of stamps (N,), seconds and rising, and poses (N, 4, 4), metres.")
      .def_static("from_tum", &of_tum, nb::arg("rows"),
                  "Of rows (N, 8): stamp tx ty tz qx qy qz qw; seconds, metres, unit quaternion.")
      .def_static(
          "read",
          [](const std::filesystem::path& path, const std::string& format) {
            return interruptible([file = path.string(), format] {
              return read_trajectory_file(file, format).poses;
            });
          },
          nb::arg("path"), nb::arg("format") = "auto",
          "Of a file: TUM's format and the others that `dxslam eval` reads.")
      .def(
          "write",
          [](const Trajectory& poses, const std::filesystem::path& path) {
            write_trajectory(path.string(), poses);
          },
          nb::arg("path"), nb::call_guard<nb::gil_scoped_release>(),
          "Writes a file in TUM's format, whole or not at all: microseconds, 1e-9 m.");
}

}  // namespace

void bind_trajectory(nb::module_& m) {
  nb::class_<Trajectory> trajectory(
      m, "Trajectory",
      "Poses of a camera by rising stamp. `numpy.asarray(trajectory)` is its to_tum().");
  bind_making(trajectory);
  trajectory
      .def_prop_ro(
          "stamps",
          [](const Trajectory& poses) {
            return column_array<double>(poses, [](const StampedPose& p) { return p.stamp; });
          },
          kOwned, "(N,) float64, seconds.")
      .def_prop_ro(
          "world_from_camera",
          [](const Trajectory& poses) {
            return poses_array(poses, [](const StampedPose& p) { return p.world_from_camera; });
          },
          kOwned,
          "(N, 4, 4) float64: x_world = world_from_camera @ x_camera, metres; the camera looks "
          "along z, y is down.")
      .def_prop_ro(
          "positions",
          [](const Trajectory& poses) {
            return rows_array<Array<double, -1, 3>>(poses, 3, [](const StampedPose& p) {
              const Eigen::Vector3d& t = p.world_from_camera.translation();
              return std::array<double, 3>{t.x(), t.y(), t.z()};
            });
          },
          kOwned, "(N, 3) float64, metres: where the camera was.")
      .def("to_tum", &to_tum,
           "(N, 8) float64: stamp tx ty tz qx qy qz qw; seconds, metres, unit quaternion.")
      .def(
          "__array__",
          [](const Trajectory& poses, const nb::object& dtype, const nb::object&) {
            const nb::object rows = nb::cast(to_tum(poses));
            return dtype.is_none() ? rows : rows.attr("astype")(dtype);
          },
          nb::arg("dtype") = nb::none(), nb::arg("copy") = nb::none(), "As to_tum().")
      .def("__len__", [](const Trajectory& poses) { return poses.size(); })
      .def("__repr__", [](const Trajectory& poses) {
        if (poses.empty()) return std::string("Trajectory(no pose)");
        return fmt::format("Trajectory({} poses, {:.3f} s to {:.3f} s)", poses.size(),
                           poses.front().stamp, poses.back().stamp);
      });
}

}  // namespace dxslam::python
