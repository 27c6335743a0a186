// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <nanobind/operators.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <limits>
#include <map>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "core/camera.h"
#include "io/calibration/calibration.h"

namespace dxslam::python {
namespace {

using Pixels = Array<double, -1, 2>;
using PixelsArgument = ArrayArgument<double, -1, 2>;
using PointsArgument = ArrayArgument<double, -1, 3>;

// All numbers through the reader of camera files, which has the names, the checks and the
// sentences.
Camera make_camera(int width, int height, double fx, double fy, double cx, double cy,
                   const std::string& lens, double fps, double depth_factor, double depth_baseline,
                   double disparity_noise, double max_depth, double readout_time,
                   const nb::kwargs& lens_parameters) {
  std::string yaml = fmt::format(
      "width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\nlens: {}\nfps: {}\n"
      "depth_factor: {}\ndepth_baseline: {}\ndisparity_noise: {}\nmax_depth: {}\n"
      "readout_time: {}\n",
      width, height, fx, fy, cx, cy, lens, fps, depth_factor, depth_baseline, disparity_noise,
      max_depth, readout_time);
  for (const auto& [name, value] : lens_parameters) {
    yaml += fmt::format("{}: {}\n", nb::cast<std::string>(name), nb::cast<double>(value));
  }
  return parse_camera(yaml, "Camera()");
}

std::map<std::string, double> lens_parameters(const Camera& camera) {
  std::map<std::string, double> parameters;
  for (std::size_t i = 0; i < camera.lens.model->parameter_count(); ++i) {
    parameters[camera.lens.model->parameters[i]] = camera.lens.parameters[i];
  }
  return parameters;
}

// One pixel per row; not a number where `pixel_of`, which takes the row, has none.
template <class Rows, class PixelOf>
Pixels pixels_of(const Rows& rows, const PixelOf& pixel_of) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> numbers;
  numbers.reserve(rows.shape(0) * 2);
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const std::optional<Eigen::Vector2d> pixel = pixel_of(rows.data() + i * rows.shape(1));
    numbers.push_back(pixel ? pixel->x() : kNone);
    numbers.push_back(pixel ? pixel->y() : kNone);
  }
  return to_array<Pixels>(std::move(numbers), {rows.shape(0), 2});
}

void bind_fields(nb::class_<Camera>& camera) {
  camera.def_ro("width", &Camera::width, "Pixels.")
      .def_ro("height", &Camera::height, "Pixels.")
      .def_ro("fx", &Camera::fx, "Focal length, pixels.")
      .def_ro("fy", &Camera::fy, "Focal length, pixels.")
      .def_ro("cx", &Camera::cx, "Principal point, pixels; pixel centres are at whole numbers.")
      .def_ro("cy", &Camera::cy, "Principal point, pixels; pixel centres are at whole numbers.")
      .def_prop_ro(
          "lens", [](const Camera& c) { return std::string(c.lens.model->name); },
          "Model of the lens: radtan, rational, kannala_brandt or double_sphere.")
      .def_prop_ro("lens_parameters", &lens_parameters,
                   "Parameters of the lens by name, dimensionless.")
      .def_ro("fps", &Camera::fps, "Nominal frame rate, 1/s.")
      .def_ro("depth_factor", &Camera::depth_factor, "Raw depth of one metre.")
      .def_ro("depth_baseline", &Camera::depth_baseline, "Baseline of the depth sensor, metres.")
      .def_ro("disparity_noise", &Camera::disparity_noise,
              "Deviation of the depth sensor's disparity, as a share of a keypoint's.")
      .def_ro("max_depth", &Camera::max_depth, "Metres; farther readings count as missing.")
      .def_ro("readout_time", &Camera::readout_time,
              "Seconds from the first to the last row of a rolling shutter; 0: all at once.");
}

void bind_geometry(nb::class_<Camera>& camera) {
  camera
      .def(
          "project",
          [](const Camera& c, const PointsArgument& points) {
            return pixels_of(points, [&](const double* p) -> std::optional<Eigen::Vector2d> {
              if (!(p[2] > 0.0)) return std::nullopt;
              return c.distort(c.project({p[0], p[1], p[2]}));
            });
          },
          nb::arg("points"),
          "Raw pixels (N, 2) of points (N, 3) in the camera frame, metres: x right, y down, z "
          "forward. NaN for points that are not in front.")
      .def(
          "undistort",
          [](const Camera& c, const PixelsArgument& pixels) {
            return pixels_of(pixels, [&](const double* p) { return c.undistort({p[0], p[1]}); });
          },
          nb::arg("pixels"),
          "Raw pixels (N, 2) as an ideal pinhole with the same intrinsics would have them, (N, 2). "
          "NaN where a fisheye shows directions that are not used.")
      .def(
          "distort",
          [](const Camera& c, const PixelsArgument& pixels) {
            return pixels_of(pixels, [&](const double* p) -> std::optional<Eigen::Vector2d> {
              return c.distort({p[0], p[1]});
            });
          },
          nb::arg("pixels"), "The inverse of undistort(): (N, 2) to (N, 2), pixels.");
}

}  // namespace

void bind_camera(nb::module_& m) {
  const Camera defaults;
  nb::class_<Camera> camera(
      m, "Camera",
      "A colour camera with the depth sensor that is registered to it. Immutable.\n\n"
      "Names, units and checks are those of camera files (`dxslam config dump --camera tum_fr1`). "
      "Parameters of the lens follow by name: k1, k2, p1, p2, k3 for radtan, and so on.\n"
      "Raises InputError for values that cannot be those of a camera.");
  camera
      .def(
          "__init__",
          [](Camera* self, int width, int height, double fx, double fy, double cx, double cy,
             const std::string& lens, double fps, double depth_factor, double depth_baseline,
             double disparity_noise, double max_depth, double readout_time,
             const nb::kwargs& parameters) {
            new (self) Camera(make_camera(width, height, fx, fy, cx, cy, lens, fps, depth_factor,
                                          depth_baseline, disparity_noise, max_depth, readout_time,
                                          parameters));
          },
          nb::arg("width"), nb::arg("height"), nb::arg("fx"), nb::arg("fy"), nb::arg("cx"),
          nb::arg("cy"), nb::kw_only(), nb::arg("lens") = defaults.lens.model->name,
          nb::arg("fps") = defaults.fps, nb::arg("depth_factor") = defaults.depth_factor,
          nb::arg("depth_baseline") = defaults.depth_baseline,
          nb::arg("disparity_noise") = defaults.disparity_noise,
          nb::arg("max_depth") = defaults.max_depth,
          nb::arg("readout_time") = defaults.readout_time, nb::arg("lens_parameters"),
          "Lengths of the image in pixels, of the scene in metres; see the properties.")
      .def_static(
          "load", [](const std::filesystem::path& file) { return load_camera(file.string()); },
          nb::arg("name_or_file"),
          "A preset, or a camera file: dxslam's own YAML, OpenCV's and ORB-SLAM's YAML, ROS "
          "camera_info, Kalibr. What has a '/' or a '.' in it is a file.")
      .def_static(
          "parse", [](const std::string& text) { return parse_camera(text, "the calibration"); },
          nb::arg("text"), "The same of a file's text.")
      .def_static("presets", &camera_preset_names, "Names of the presets.")
      .def(
          "to_yaml", [](const Camera& c) { return dump_camera(c, "camera"); },
          "A camera file that load() reads back to the same camera.")
      .def(
          "__eq__", [](const Camera& a, const Camera& b) { return a == b; }, nb::is_operator(),
          nb::sig("def __eq__(self, other: object, /) -> bool"), "All values the same.")
      .def("__hash__", [](const Camera& c) { return std::hash<std::string>()(dump_camera(c, "")); })
      .def("__repr__", [](const Camera& c) {
        return fmt::format("Camera({} x {}, fx={:g}, fy={:g}, cx={:g}, cy={:g}, lens={})", c.width,
                           c.height, c.fx, c.fy, c.cx, c.cy, c.lens.model->name);
      });
  bind_fields(camera);
  bind_geometry(camera);
}

}  // namespace dxslam::python
