// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/calibration/foreign_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_text.h"

namespace dxslam {
namespace {

struct RosLens {
  const char* name;
  const LensModel* model;
};

// The names of ROS, Kalibr and librealsense; for each model that of ROS first.
constexpr std::array<RosLens, 9> kRosLenses = {{{"plumb_bob", &kRadialTangential},
                                                {"Brown Conrady", &kRadialTangential},
                                                {"Modified Brown Conrady", &kRadialTangential},
                                                {"rational_polynomial", &kRational},
                                                {"equidistant", &kKannalaBrandt},
                                                {"fisheye", &kKannalaBrandt},
                                                {"kannala_brandt4", &kKannalaBrandt},
                                                {"radtan", &kRadialTangential},
                                                {"equi", &kKannalaBrandt}}};

// Letters and digits, small: "Kannala Brandt4" is kannala_brandt4.
std::string letters_of(const std::string& name) {
  std::string letters;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return letters;
}

Lens make_lens(const LensModel& model, const std::vector<double>& values) {
  Lens lens;
  lens.model = &model;
  std::copy_n(values.begin(), std::min(values.size(), model.parameter_count()),
              lens.parameters.begin());
  return lens;
}

// The document of one form, and what it says.
class Document {
 public:
  Document(YAML::Node root, std::string where) : root_(std::move(root)), where_(std::move(where)) {}

  bool has(const std::string& key) const { return yaml_child(root_, key).IsDefined(); }
  Document part(const std::string& key) const {
    return {yaml_child(root_, key), fmt::format("{}: {}", where_, key)};
  }

  std::string text(const std::string& key) const { return yaml_scalar(yaml_child(root_, key)); }
  double number(const std::string& key) const {
    if (const auto value = parse_number(text(key)); value && std::isfinite(*value)) return *value;
    throw InputError(fmt::format("{}: {} is missing or no number, expected it there", where_, key));
  }
  double number_or(const std::string& key, double otherwise) const {
    return has(key) ? number(key) : otherwise;
  }
  /// The numbers of a list, or of the "data" of a matrix; `least` of them at least.
  std::vector<double> numbers(const std::string& key, std::size_t least) const {
    YAML::Node list = yaml_child(root_, key);
    if (list && list.IsMap()) list.reset(yaml_child(list, "data"));
    const auto values = finite_numbers(list);
    if (values && values->size() >= least) return *values;
    if (!list && least == 0) return {};
    throw InputError(fmt::format("{}: {} is no list of {}finite numbers", where_, key,
                                 least > 0 ? fmt::format("at least {} ", least) : std::string()));
  }
  int pixels(const std::string& key) const {
    return static_cast<int>(std::clamp(number(key), 0.0, 1e6));
  }
  const std::string& where() const { return where_; }

 private:
  YAML::Node root_;
  std::string where_;
};

void set_intrinsics(Camera& camera, double fx, double fy, double cx, double cy) {
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
}

// ORB-SLAM2 and the older settings of ORB-SLAM3 say Camera.fx, the newer ones Camera1.fx.
Camera from_orb_slam(const Document& d) {
  const std::string prefix = d.has("Camera1.fx") ? "Camera1." : "Camera.";
  Camera camera;
  set_intrinsics(camera, d.number(prefix + "fx"), d.number(prefix + "fy"), d.number(prefix + "cx"),
                 d.number(prefix + "cy"));
  if (!d.has("Camera.width") || !d.has("Camera.height")) {
    throw InputError(d.where() +
                     ": no image size in these settings of ORB-SLAM, expected lines Camera.width "
                     "and Camera.height");
  }
  camera.width = d.pixels("Camera.width");
  camera.height = d.pixels("Camera.height");
  camera.fps = d.number_or("Camera.fps", camera.fps);
  camera.depth_factor =
      d.number_or("RGBD.DepthMapFactor", d.number_or("DepthMapFactor", camera.depth_factor));
  const std::string type = d.text("Camera.type");
  if (type == "Rectified") return camera;
  if (type != "" && type != "PinHole" && type != "KannalaBrandt8") {
    throw InputError(
        fmt::format("{}: Camera.type is {}, expected PinHole, Rectified or KannalaBrandt8",
                    d.where(), in_quotes(type)));
  }
  camera.lens.model = type == "KannalaBrandt8" ? &kKannalaBrandt : &kRadialTangential;
  for (std::size_t i = 0; i < camera.lens.model->parameter_count(); ++i) {
    camera.lens.parameters[i] = d.number_or(prefix + camera.lens.model->parameters[i], 0.0);
  }
  return camera;
}

// What the calibrator of ROS writes, or a message as text; its matrix is K in ROS 1, k in ROS 2.
Camera from_camera_info(const Document& d) {
  const bool file = d.has("camera_matrix");
  const std::string matrix = file ? "camera_matrix" : d.has("K") ? "K" : "k";
  const std::string coefficients = file ? "distortion_coefficients" : d.has("D") ? "D" : "d";
  const std::vector<double> k = d.numbers(matrix, 9);
  Camera camera;
  set_intrinsics(camera, k[0], k[4], k[2], k[5]);
  camera.width = d.pixels(file ? "image_width" : "width");
  camera.height = d.pixels(file ? "image_height" : "height");
  camera.lens = lens_from_ros(d.text("distortion_model"), d.numbers(coefficients, 0), d.where());
  return camera;
}

Camera from_kalibr(const Document& chain) {
  if (chain.has("cam1")) {
    throw InputError(chain.where() +
                     ": a camchain of several cameras, expected cam0 alone, the one of the colour "
                     "images");
  }
  const Document d = chain.part("cam0");
  const std::string model = d.text("camera_model");
  const std::vector<double> size = d.numbers("resolution", 2);
  Camera camera;
  camera.width = static_cast<int>(std::clamp(size[0], 0.0, 1e6));
  camera.height = static_cast<int>(std::clamp(size[1], 0.0, 1e6));
  if (model == "ds") {
    const std::vector<double> values = d.numbers("intrinsics", 6);
    set_intrinsics(camera, values[2], values[3], values[4], values[5]);
    camera.lens = make_lens(kDoubleSphere, values);
    return camera;
  }
  if (model != "pinhole") {
    throw InputError(
        fmt::format("{}: camera_model is {}, expected pinhole or ds", d.where(), in_quotes(model)));
  }
  const std::vector<double> values = d.numbers("intrinsics", 4);
  set_intrinsics(camera, values[0], values[1], values[2], values[3]);
  camera.lens =
      lens_from_ros(d.text("distortion_model"), d.numbers("distortion_coeffs", 0), d.where());
  return camera;
}

}  // namespace

Lens lens_from_ros(const std::string& distortion_model, const std::vector<double>& coefficients,
                   const std::string& where) {
  const bool all_zero = std::all_of(coefficients.begin(), coefficients.end(),
                                    [](double value) { return value == 0.0; });
  const std::string name = letters_of(distortion_model);
  const bool is_inverse = name == "inversebrownconrady";  // the same where nothing is bent
  if (all_zero && (name.empty() || name == "none" || is_inverse)) return {};
  if (name.empty() || name == "none") {
    throw InputError(fmt::format("{}: distortion without the name of its model", where));
  }
  std::vector<const char*> names;
  for (const RosLens& known : kRosLenses) {
    names.push_back(known.name);
    if (name != letters_of(known.name)) continue;
    const std::size_t most = known.model->parameter_count();
    // Drivers fill up with zeros, and a plumb_bob without k3 has four.
    const bool surplus = std::any_of(
        coefficients.begin() + static_cast<std::ptrdiff_t>(std::min(most, coefficients.size())),
        coefficients.end(), [](double value) { return value != 0.0; });
    if (surplus) {
      throw InputError(fmt::format("{}: {} numbers for a lens {}, expected at most {}", where,
                                   coefficients.size(), distortion_model, most));
    }
    if (all_zero && known.model->ideal_at_zero) return {};
    return make_lens(*known.model, coefficients);
  }
  throw InputError(fmt::format("{}: distortion model {}, expected one of {}", where,
                               in_quotes(distortion_model), fmt::join(names, ", ")));
}

std::string ros_lens_name(const LensModel& model) {
  for (const RosLens& known : kRosLenses) {
    if (known.model == &model) return known.name;
  }
  return model.name;
}

std::optional<Camera> parse_foreign_calibration(const std::string& yaml, const std::string& where) {
  const YAML::Node root = parse_opencv_yaml(yaml, where);
  if (!root.IsMap()) return std::nullopt;
  const Document d(root, where);
  if (d.has("Camera.fx") || d.has("Camera1.fx")) return from_orb_slam(d);
  if (d.has("cam0")) return from_kalibr(d);
  if (d.has("camera_matrix") || d.has("K") || d.has("k")) return from_camera_info(d);
  return std::nullopt;
}

}  // namespace dxslam
