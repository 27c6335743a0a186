// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/openvino_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <openvino/openvino.hpp>
#include <optional>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/openvino_model.h"

namespace dxslam {
namespace {

/// One OpenVINO runtime for the whole program, alive as long as an engine uses it.
std::shared_ptr<ov::Core> shared_core() {
  static std::mutex mutex;
  static std::weak_ptr<ov::Core> weak;
  const std::lock_guard<std::mutex> lock(mutex);
  auto core = weak.lock();
  if (!core) {
    core = std::make_shared<ov::Core>();
    weak = core;
  }
  return core;
}

ov::Shape input_shape(const InputDescription& input, int height, int width) {
  const auto c = static_cast<std::size_t>(input.channels);
  const auto h = static_cast<std::size_t>(height);
  const auto w = static_cast<std::size_t>(width);
  return input.layout == TensorLayout::kNchw ? ov::Shape{1, c, h, w} : ov::Shape{1, h, w, c};
}

/// Maps that are read position by position leave the network with their channels side by side;
/// full-resolution ones stay as they are, being larger than what is read of them.
bool wants_nhwc(const OutputSpec& spec) {
  return spec.layout == TensorLayout::kNchw && spec.stride >= 4 && spec.channels > 1;
}

std::vector<float> in_pixel_units(const std::vector<double>& values, double scale) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(value / scale));
  return result;
}

/// Images normalised one by one come as floats.
ov::element::Type input_type(const InputDescription& input) {
  return input.instance_normalized ? ov::element::f32 : ov::element::u8;
}

void add_preprocessing(ov::preprocess::PrePostProcessor& steps, const InputDescription& input) {
  auto& port = steps.input(0);
  port.tensor().set_element_type(input_type(input)).set_layout("NHWC");
  port.model().set_layout(input.layout == TensorLayout::kNchw ? "NCHW" : "NHWC");
  auto& chain = port.preprocess();
  if (input.channels == 3) {
    port.tensor().set_color_format(ov::preprocess::ColorFormat::BGR);
    if (!input.bgr) chain.convert_color(ov::preprocess::ColorFormat::RGB);
  }
  chain.convert_element_type(ov::element::f32);
  if (!input.mean.empty()) chain.mean(in_pixel_units(input.mean, input.scale));
  if (!input.deviation.empty()) {
    chain.scale(in_pixel_units(input.deviation, input.scale));
  } else if (input.scale != 1.0) {
    chain.scale(static_cast<float>(1.0 / input.scale));
  }
}

void add_postprocessing(ov::preprocess::PrePostProcessor& steps,
                        const std::vector<OutputSpec>& specs) {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    auto& port = steps.output(i);
    port.tensor().set_element_type(ov::element::f32);
    if (!wants_nhwc(specs[i])) continue;
    port.model().set_layout("NCHW");
    port.tensor().set_layout("NHWC");
  }
}

std::vector<OutputSpec> local_outputs(const ModelManifest& manifest) {
  std::vector<OutputSpec> specs;
  if (manifest.keypoint_logits) {
    specs.push_back({"outputs.keypoint_logits", manifest.keypoint_logits->name,
                     manifest.keypoint_logits->layout, manifest.cell_size * manifest.cell_size + 1,
                     manifest.cell_size});
  }
  if (manifest.scores) {
    specs.push_back({"outputs.scores", manifest.scores->name, manifest.scores->layout, 1, 1});
  }
  specs.push_back({"outputs.descriptors", manifest.descriptors.name, manifest.descriptors.layout,
                   manifest.descriptor.dimension, manifest.descriptor.stride});
  if (manifest.reliability) {
    specs.push_back({"outputs.reliability", manifest.reliability->name,
                     manifest.reliability->layout, 1, manifest.descriptor.stride});
  }
  return specs;
}

const char* key_of(OutputRole role) {
  switch (role) {
    case OutputRole::kKeypointLogits:
      return "outputs.keypoint_logits";
    case OutputRole::kScores:
      return "outputs.scores";
    case OutputRole::kDescriptors:
      return "outputs.descriptors";
    case OutputRole::kReliability:
      return "outputs.reliability";
  }
  return "";
}

/// Which variant runs, and what arithmetic the float layers use.
struct Precision {
  bool int8 = false;
  bool bf16_allowed = false;
  std::string name;
};

Precision choose_precision(const ModelManifest& manifest, const ExtractorOptions& options) {
  const std::string& wanted = options.precision;
  if (wanted != "auto" && wanted != "f32" && wanted != "bf16" && wanted != "int8") {
    throw InputError(
        fmt::format("option precision is `{}`, expected auto, f32, bf16 or int8", wanted));
  }
  if (wanted == "int8" && !manifest.has_int8()) {
    throw InputError(fmt::format("{}: has no INT8 model, expected files.int8 for precision int8",
                                 manifest.path));
  }
  if (wanted == "int8" || (wanted == "auto" && manifest.has_int8() && !options.deterministic)) {
    return {true, false, "int8"};
  }
  if (wanted == "f32" || options.deterministic) return {false, false, "f32"};
  const auto capabilities = shared_core()->get_property("CPU", ov::device::capabilities);
  const bool bf16 = std::find(capabilities.begin(), capabilities.end(),
                              ov::device::capability::BF16) != capabilities.end();
  return {false, bf16, bf16 ? "bf16" : "f32"};
}

}  // namespace

class OpenVinoEngine::Impl {
 public:
  Impl(const ModelManifest& manifest, const ExtractorOptions& options)
      : manifest_(manifest),
        options_(options),
        core_(shared_core()),
        precision_(choose_precision(manifest, options)) {
    local_specs_ = local_outputs(manifest_);
    local_count_ = local_specs_.size();
    const ModelFile& file = pick(manifest_.files);
    path_ = file.path;
    const auto model = load(file);
    local_ = keep_outputs(*model, with_features(), path_);
    check_input(*local_, manifest_.input, path_);
    if (manifest_.global) {
      full_ = keep_outputs(*model, with_global(), path_);
      check_input(*full_, manifest_.input, path_);
    }
    if (manifest_.global_head) {
      const ModelFile& head_file = pick(manifest_.global_head->files);
      head_path_ = head_file.path;
      const auto head = read_model(head_file, {manifest_.global_head->output});
      head_ = keep_outputs(*head, {head_spec()}, head_path_);
      check_input_name(*head_, manifest_.global_head->input, head_path_);
    }
    if (manifest_.input.fixed_width > 0) {
      prepare(manifest_.input.fixed_width, manifest_.input.fixed_height);
    }
  }

  void run(const cv::Mat& image, bool with_global) {
    const int depth = manifest_.input.instance_normalized ? CV_32F : CV_8U;
    require(image.isContinuous() && image.depth() == depth &&
                image.channels() == manifest_.input.channels,
            "OpenVinoEngine::run wants a continuous image of the network's depth and channels");
    Compiled& compiled = prepare(image.cols, image.rows);
    const bool full = with_global && full_;
    if (full && !compiled.full) {
      compiled.full = compile(*full_, this->with_global(), path_, image.rows, image.cols);
    }
    current_ = full ? &*compiled.full : &compiled.local;
    const ov::Shape shape{1, static_cast<std::size_t>(image.rows),
                          static_cast<std::size_t>(image.cols),
                          static_cast<std::size_t>(image.channels())};
    current_->set_input_tensor(ov::Tensor(input_type(manifest_.input), shape, image.data));
    infer(*current_, path_);
    global_.clear();
    if (with_global && head_) {
      run_head(compiled);
    } else if (full) {
      copy_global(current_->get_output_tensor(local_count_));
    }
  }

  TensorView output(OutputRole role) const {
    require(current_ != nullptr, "OpenVinoEngine::output is called before run");
    for (std::size_t i = 0; i < local_count_; ++i) {
      const OutputSpec& spec = local_specs_[i];
      if (spec.key != key_of(role)) continue;
      const ov::Tensor tensor = current_->get_output_tensor(i);
      const ov::Shape input = current_->get_input_tensor().get_shape();
      const int height = static_cast<int>(input[1]) / spec.stride;
      const int width = static_cast<int>(input[2]) / spec.stride;
      const float* data = tensor.data<const float>();
      const bool nchw = spec.layout == TensorLayout::kNchw && !wants_nhwc(spec);
      return nchw ? TensorView::nchw(data, spec.channels, height, width)
                  : TensorView::nhwc(data, spec.channels, height, width);
    }
    throw ContractError(fmt::format("the model has no {}", key_of(role)));
  }

  std::vector<float> global() const { return global_; }
  const std::string& precision() const { return precision_.name; }

 private:
  struct Compiled {
    ov::InferRequest local;
    std::optional<ov::InferRequest> full;
    std::optional<ov::InferRequest> head;
  };

  const ModelFile& pick(const ModelVariants& variants) const {
    return precision_.int8 && variants.int8.given() ? variants.int8 : variants.floating;
  }

  std::shared_ptr<ov::Model> load(const ModelFile& file) const {
    std::vector<std::string> names;
    for (const OutputSpec& spec : with_features()) names.push_back(spec.name);
    if (manifest_.global) names.push_back(manifest_.global->name);
    return read_model(file, names);
  }

  /// The local outputs and, for a separate global head, what that reads.
  std::vector<OutputSpec> with_features() const {
    auto specs = local_specs_;
    if (manifest_.global_head) {
      specs.push_back({"outputs.features", manifest_.features->name, TensorLayout::kNchw, 0, 0});
    }
    return specs;
  }

  std::vector<OutputSpec> with_global() const {
    auto specs = local_specs_;
    specs.push_back({"outputs.global", manifest_.global->name, TensorLayout::kNchw,
                     manifest_.global_dimension, 0});
    return specs;
  }

  OutputSpec head_spec() const {
    return {"global_head.output", manifest_.global_head->output, TensorLayout::kNchw,
            manifest_.global_dimension, 0};
  }

  Compiled& prepare(int width, int height) {
    const auto key = std::make_pair(width, height);
    const auto found = compiled_.find(key);
    if (found != compiled_.end()) return found->second;
    Compiled compiled;
    compiled.local = compile(*local_, with_features(), path_, height, width);
    return compiled_.emplace(key, std::move(compiled)).first->second;
  }

  ov::InferRequest compile(const ov::Model& model, const std::vector<OutputSpec>& specs,
                           const std::string& path, int height, int width) const {
    auto sized = model.clone();
    try {
      sized->reshape(ov::PartialShape(input_shape(manifest_.input, height, width)));
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: cannot be set to an input of {} x {} pixels: {}", path,
                                   width, height, short_reason(e)));
    }
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const bool checked = specs[i].key != "outputs.features";
      const auto& port = std::as_const(*sized).output(i);
      if (checked) check_output(port, specs[i], height, width, path);
    }
    ov::preprocess::PrePostProcessor steps(sized);
    add_preprocessing(steps, manifest_.input);
    add_postprocessing(steps, specs);
    return compile(steps.build(), path);
  }

  ov::InferRequest compile(const std::shared_ptr<ov::Model>& model, const std::string& path) const {
    ov::AnyMap properties{ov::hint::performance_mode(ov::hint::PerformanceMode::LATENCY),
                          ov::num_streams(1), ov::inference_num_threads(options_.threads)};
    if (!precision_.bf16_allowed) {
      properties.insert(ov::hint::inference_precision(ov::element::f32));
    } else {
      properties.insert(ov::hint::inference_precision(ov::element::bf16));
    }
    const std::string cache = options_.cache_dir == "auto" ? cache_directory() : options_.cache_dir;
    if (!cache.empty()) properties.insert(ov::cache_dir(cache));
    try {
      return core_->compile_model(model, "CPU", properties).create_infer_request();
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: cannot be compiled: {}", path, short_reason(e)));
    }
  }

  static void infer(ov::InferRequest& request, const std::string& path) {
    try {
      request.infer();
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: the network failed: {}", path, short_reason(e)));
    }
  }

  void run_head(Compiled& compiled) {
    const ov::Tensor features = compiled.local.get_output_tensor(local_count_);
    if (!compiled.head) {
      compiled.head = compile_head(features);
      compiled.head->set_input_tensor(features);
    }
    infer(*compiled.head, head_path_);
    copy_global(compiled.head->get_output_tensor(0));
  }

  ov::InferRequest compile_head(const ov::Tensor& features) const {
    auto sized = head_->clone();
    try {
      sized->reshape(ov::PartialShape(features.get_shape()));
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: input {} cannot take the features of shape {}: {}",
                                   head_path_, manifest_.global_head->input,
                                   ov::PartialShape(features.get_shape()).to_string(),
                                   short_reason(e)));
    }
    check_output(std::as_const(*sized).output(0), head_spec(), 0, 0, head_path_);
    ov::preprocess::PrePostProcessor steps(sized);
    steps.input(0).tensor().set_element_type(ov::element::f32);
    steps.output(0).tensor().set_element_type(ov::element::f32);
    return compile(steps.build(), head_path_);
  }

  void copy_global(const ov::Tensor& tensor) {
    const float* data = tensor.data<const float>();
    global_.assign(data, data + tensor.get_size());
  }

  ModelManifest manifest_;
  ExtractorOptions options_;
  std::shared_ptr<ov::Core> core_;
  Precision precision_;
  std::vector<OutputSpec> local_specs_;
  std::size_t local_count_ = 0;
  std::string path_;
  std::string head_path_;
  std::shared_ptr<ov::Model> local_;
  std::shared_ptr<ov::Model> full_;
  std::shared_ptr<ov::Model> head_;
  std::map<std::pair<int, int>, Compiled> compiled_;
  ov::InferRequest* current_ = nullptr;
  std::vector<float> global_;
};

OpenVinoEngine::OpenVinoEngine(const ModelManifest& manifest, const ExtractorOptions& options)
    : impl_(std::make_unique<Impl>(manifest, options)) {}
OpenVinoEngine::~OpenVinoEngine() = default;
void OpenVinoEngine::run(const cv::Mat& image, bool with_global) { impl_->run(image, with_global); }
TensorView OpenVinoEngine::output(OutputRole role) const { return impl_->output(role); }
std::vector<float> OpenVinoEngine::global() const { return impl_->global(); }
const std::string& OpenVinoEngine::precision() const { return impl_->precision(); }

}  // namespace dxslam
