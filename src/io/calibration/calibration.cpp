// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/calibration/calibration.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "io/calibration/calibration_presets.h"
#include "io/calibration/foreign_calibration.h"
#include "io/formats/options_yaml.h"

namespace dxslam {
namespace {

// The fields of Camera as options, so that reading and dumping are those of every options struct.
struct CameraFields : Camera {
  std::string lens_name = Lens().model->name;
  std::string where;

  // While a file is read: those of other lenses are unknown keys.
  void choose_lens();
  void choose_lens() const {}

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("width", self.width, {16, 16384}, "pixels", "image width");
    visit("height", self.height, {16, 16384}, "pixels", "image height");
    visit("fx", self.fx, {1, 1e5}, "pixels", "focal length");
    visit("fy", self.fy, {1, 1e5}, "pixels", "focal length");
    visit("cx", self.cx, {-16384, 32768}, "pixels", "principal point, centre of pixel (0, 0) is 0");
    visit("cy", self.cy, {-16384, 32768}, "pixels", "principal point");
    visit("lens", self.lens_name, "", "radtan, rational, kannala_brandt or double_sphere");
    self.choose_lens();
    for (std::size_t i = 0; i < self.lens.model->parameter_count(); ++i) {
      visit(self.lens.model->parameters[i], self.lens.parameters[i], {-100, 100}, "",
            "parameter of the lens");
    }
    visit("fps", self.fps, {1e-3, 1e4}, "1/s", "nominal frame rate");
    visit("depth_factor", self.depth_factor, {1e-3, 1e6}, "1/m", "raw depth of one metre");
    visit("depth_baseline", self.depth_baseline, {1e-4, 10}, "m", "baseline of the depth sensor");
    visit("disparity_noise", self.disparity_noise, {1e-3, 100}, "",
          "deviation of the depth sensor's disparity as a share of a keypoint's");
    visit("max_depth", self.max_depth, {0.01, 1e4}, "m", "farther readings count as missing");
    visit("readout_time", self.readout_time, {0, 1}, "s",
          "first to last row of a rolling shutter; 0 = all rows at once");
  }
};

void CameraFields::choose_lens() {
  lens.model = find_lens_model(lens_name);
  if (lens.model != nullptr) return;
  std::vector<std::string> known;
  for (const LensModel* model : lens_models()) known.emplace_back(model->name);
  throw InputError(fmt::format("{}: lens is {}, expected one of {}", where, in_quotes(lens_name),
                               fmt::join(known, ", ")));
}

struct CalibrationFields : CameraFields {
  DepthCamera depth_camera;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    CameraFields::describe(self, visit);
    visit.group("depth_camera", self.depth_camera);
  }
};

void require_fields(YamlMap& map, const std::string& where, const std::vector<const char*>& names) {
  for (const char* name : names) {
    std::string value;
    if (map.take(name, value)) continue;
    throw InputError(
        fmt::format("{}: no {} in it, expected {}", where, name, fmt::join(names, ", ")));
  }
}

void require_intrinsics(const std::string& yaml, const std::string& where) {
  YamlMap map = YamlMap::parse(yaml, where);
  require_fields(map, where, {"width", "height", "fx", "fy", "cx", "cy"});
  if (auto depth_camera = map.take_map("depth_camera")) {
    require_fields(*depth_camera, depth_camera->where() + " (depth_camera)",
                   {"fx", "fy", "cx", "cy"});
  }
}

}  // namespace

RgbdCalibration parse_calibration(const std::string& yaml, const std::string& where) {
  if (std::optional<Camera> foreign = parse_foreign_calibration(yaml, where)) {
    foreign->prepare(where);
    return {*foreign, {}};
  }
  CalibrationFields fields;
  fields.where = where;
  read_options_yaml(yaml, where, fields);
  require_intrinsics(yaml, where);
  fields.prepare(where);
  if ((fields.depth_camera.fx == 0.0) != (fields.depth_camera.fy == 0.0)) {
    throw InputError(fmt::format("{}: depth_camera has fx {} and fy {}, expected both or none",
                                 where, fields.depth_camera.fx, fields.depth_camera.fy));
  }
  return {fields, fields.depth_camera};
}

Camera parse_camera(const std::string& yaml, const std::string& where) {
  return parse_calibration(yaml, where).camera;
}

RgbdCalibration load_calibration(const std::string& name_or_file) {
  if (name_or_file.find_first_of("/.") == std::string::npos) {
    return parse_calibration(camera_preset_text(name_or_file), "preset " + name_or_file);
  }
  return parse_calibration(read_file(name_or_file, "a camera file (YAML)", limits::kYamlBytes),
                           name_or_file);
}

Camera load_camera(const std::string& name_or_file) {
  return load_calibration(name_or_file).camera;
}

std::vector<std::string> camera_preset_names() {
  std::vector<std::string> names;
  for (const CameraPreset& preset : camera_presets()) names.push_back(preset.name);
  return names;
}

const std::string& camera_preset_text(const std::string& name) {
  std::string known;
  for (const CameraPreset& preset : camera_presets()) {
    if (preset.name == name) return preset.yaml;
    known += (known.empty() ? "" : ", ") + preset.name;
  }
  throw InputError(fmt::format("no camera preset {}, expected a YAML file or one of {}",
                               in_quotes(name), known));
}

std::string dump_camera(const Camera& camera, const std::string& title) {
  CameraFields fields;
  static_cast<Camera&>(fields) = camera;
  fields.lens_name = camera.lens.model->name;
  return "# " + title + "\n" + dump_options_yaml(fields);
}

}  // namespace dxslam
