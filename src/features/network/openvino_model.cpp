// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/openvino_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <openvino/frontend/manager.hpp>
#include <sstream>

#include "core/error.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

std::string text(const ov::PartialShape& shape) { return shape.to_string(); }

bool same_name(const std::string& wanted, const std::string& found) {
  return found == wanted || found == wanted + ":0";
}

template <class Port>
bool has_name(const Port& port, const std::string& wanted) {
  const auto& names = port.get_names();
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return same_name(wanted, name); }) ||
         same_name(wanted, port.get_node()->get_friendly_name());
}

template <class Ports>
std::string list_names(const Ports& ports) {
  std::vector<std::string> names;
  for (const auto& port : ports) {
    names.push_back(port.get_names().empty() ? port.get_node()->get_friendly_name()
                                             : *port.get_names().begin());
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

/// Name of OpenVINO's front end for a file. Trying all of them, as ov::Core does, would let some
/// print on stderr.
std::string front_end_of(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".xml") return "ir";
  if (extension == ".onnx") return "onnx";
  if (extension == ".pb" || fs::is_directory(path)) return "tf";
  throw InputError(
      fmt::format("{}: found extension `{}`, expected a model (OpenVINO .xml, .onnx, "
                  "or TensorFlow .pb or saved-model folder)",
                  path, extension));
}

/// TensorFlow graphs are cut before conversion, as some operations behind the cut (the resampler
/// of the published HF-Net) cannot be converted.
void cut(ov::frontend::InputModel& graph, const std::vector<std::string>& outputs,
         const std::string& path) {
  std::vector<ov::frontend::Place::Ptr> places;
  for (const std::string& name : outputs) {
    auto place = graph.get_place_by_tensor_name(name);
    if (!place) place = graph.get_place_by_tensor_name(name + ":0");
    if (!place) place = graph.get_place_by_operation_name(name);
    if (!place) {
      throw InputError(fmt::format(
          "{}: found no tensor named {}, expected it as an output of the TensorFlow graph", path,
          name));
    }
    places.push_back(place);
  }
  graph.override_all_outputs(places);
}

/// The tensor called `name` anywhere in the model: an output, or an inner one to cut at.
ov::Output<ov::Node> find_tensor(const ov::Model& model, const std::string& name,
                                 const std::string& key, const std::string& path) {
  for (const auto& result : model.outputs()) {
    if (has_name(result, name)) return result.get_node()->input_value(0);
  }
  for (const auto& node : model.get_ordered_ops()) {
    for (const auto& port : node->outputs()) {
      if (has_name(port, name)) return port;
    }
  }
  throw InputError(fmt::format("{}: found outputs {}, expected {} for `{}`", path,
                               list_names(model.outputs()), name, key));
}

/// Blocks come as floats, or as integers of a known step.
void check_input_type(const ov::Model& model, const InputDescription& input,
                      const std::string& path) {
  const ov::element::Type type = model.input(0).get_element_type();
  if (input.unshuffle == 1 || type == ov::element::f32) return;
  if (type == ov::element::i8 && input.quantization_step > 0.0) return;
  throw InputError(
      fmt::format("{}: input {} is of type {}, expected f32, or i8 with the manifest's "
                  "input.quantization_step",
                  path, input.name, type.to_string()));
}

/// Score maps and other one-channel outputs may come without their channel axis.
bool shape_fits(const ov::Shape& found, const OutputSpec& spec, int height, int width) {
  if (spec.stride == 0) return ov::shape_size(found) == static_cast<std::size_t>(spec.channels);
  const ov::Shape expected = spec.expected_shape(height, width);
  if (found == expected) return true;
  return spec.channels == 1 && found.size() == 3 && found[0] == 1 &&
         ov::shape_size(found) == ov::shape_size(expected) &&
         found[1] == static_cast<std::size_t>(height / spec.stride);
}

}  // namespace

std::string short_reason(const std::exception& error) {
  std::istringstream lines(error.what());
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

std::shared_ptr<ov::Model> read_model(const ModelFile& file,
                                      const std::vector<std::string>& outputs) {
  verify_model_file(file);
  const std::string kind = front_end_of(file.path);
  try {
    ov::frontend::FrontEndManager manager;
    const auto front_end = manager.load_by_framework(kind);
    const auto graph = front_end->load(file.path);
    if (!graph) throw std::runtime_error("not a model");
    if (kind == "tf") cut(*graph, outputs, file.path);
    return front_end->convert(graph);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(fmt::format(
        "{}: cannot be read as a model, it is damaged or has parts that OpenVINO does not know: {}",
        file.path, short_reason(e)));
  }
}

std::shared_ptr<ov::Model> keep_outputs(const ov::Model& model,
                                        const std::vector<OutputSpec>& specs,
                                        const std::string& path) {
  ov::OutputVector outputs;
  for (const OutputSpec& spec : specs) {
    outputs.push_back(find_tensor(model, spec.name, spec.key, path));
  }
  return std::make_shared<ov::Model>(outputs, model.get_friendly_name())->clone();
}

void check_input_name(const ov::Model& model, const std::string& name, const std::string& path) {
  if (model.inputs().size() == 1 && has_name(model.input(0), name)) return;
  throw InputError(fmt::format("{}: found inputs {}, expected one called {}", path,
                               list_names(model.inputs()), name));
}

void check_input(const ov::Model& model, const InputDescription& input, const std::string& path) {
  check_input_name(model, input.name, path);
  const ov::PartialShape shape = model.input(0).get_partial_shape();
  const auto rank = shape.rank();
  const std::size_t channel = input.layout == TensorLayout::kNchw ? 1 : 3;
  if (rank.is_static() && rank.get_length() == 4 && shape[0].compatible(1) &&
      shape[channel].compatible(input.blocks())) {
    check_input_type(model, input, path);
    return;
  }
  throw InputError(
      fmt::format("{}: input {} has shape {}, expected {}", path, input.name, text(shape),
                  input.layout == TensorLayout::kNchw ? fmt::format("[1,{},H,W]", input.blocks())
                                                      : fmt::format("[1,H,W,{}]", input.blocks())));
}

void check_output(const ov::Output<const ov::Node>& port, const OutputSpec& spec, int height,
                  int width, const std::string& path) {
  const ov::PartialShape& shape = port.get_partial_shape();
  if (shape.is_static() && shape_fits(shape.to_shape(), spec, height, width)) return;
  throw InputError(
      fmt::format("{}: output {} has shape {} for an input of {} x {} pixels, expected {}", path,
                  spec.name, text(shape), width, height,
                  spec.stride == 0 ? fmt::format("{} values", spec.channels)
                                   : text(ov::PartialShape(spec.expected_shape(height, width)))));
}

}  // namespace dxslam
