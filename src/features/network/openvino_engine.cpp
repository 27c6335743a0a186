// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/openvino_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <openvino/openvino.hpp>
#include <optional>

#include "core/error.h"
#include "features/network/openvino_model.h"
#include "features/network/openvino_runtime.h"

namespace dxslam {
namespace {

ov::Shape input_shape(const InputDescription& input, int height, int width) {
  const auto c = static_cast<std::size_t>(input.blocks());
  const auto h = static_cast<std::size_t>(height / input.unshuffle);
  const auto w = static_cast<std::size_t>(width / input.unshuffle);
  return input.layout == TensorLayout::kNchw ? ov::Shape{1, c, h, w} : ov::Shape{1, h, w, c};
}

/// Maps that are read position by position leave the network with their channels side by side;
/// full-resolution ones stay as they are, being larger than what is read of them.
bool wants_nhwc(const OutputSpec& spec) {
  return spec.layout == TensorLayout::kNchw && spec.stride >= 4 && spec.channels > 1;
}

constexpr const char* kFeaturesKey = "outputs.features";

std::vector<float> in_pixel_units(const std::vector<double>& values, double scale) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(value / scale));
  return result;
}

/// Images normalised one by one come as floats, or as what the model takes.
ov::element::Type input_type(const InputDescription& input, const ov::Model& model) {
  if (input.unshuffle > 1) return model.input(0).get_element_type();
  return input.instance_normalized ? ov::element::f32 : ov::element::u8;
}

void add_preprocessing(ov::preprocess::PrePostProcessor& steps, const InputDescription& input,
                       const ov::element::Type& type) {
  auto& port = steps.input(0);
  port.tensor().set_element_type(type).set_layout("NHWC");
  port.model().set_layout(input.layout == TensorLayout::kNchw ? "NCHW" : "NHWC");
  if (input.unshuffle > 1) return;
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
    if (specs[i].key == kFeaturesKey) continue;  // as they are, for the head to read
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

}  // namespace

class OpenVinoEngine::Impl {
 public:
  Impl(const ModelManifest& manifest, const ExtractorOptions& options)
      : manifest_(manifest), compiler_(manifest, options) {
    local_specs_ = local_outputs(manifest_);
    local_count_ = local_specs_.size();
    const ModelFile& file = pick(manifest_.files);
    path_ = file.path;
    const auto model = load(file);
    local_ = keep_outputs(*model, with_features(), path_);
    check_input(*local_, manifest_.input, path_);
    input_type_ = input_type(manifest_.input, *local_);
    if (manifest_.global) prepare_whole(*model);
    if (manifest_.global_head) prepare_head();
    if (manifest_.input.fixed_width > 0) {
      prepare(manifest_.input.fixed_width, manifest_.input.fixed_height);
    }
  }

  bool integer_input() const { return input_type_ == ov::element::i8; }

  void run(const cv::Mat& image, bool with_global) {
    const ov::Shape shape{1, static_cast<std::size_t>(image.rows),
                          static_cast<std::size_t>(image.cols),
                          static_cast<std::size_t>(image.channels())};
    require(image.isContinuous() && image.channels() == manifest_.input.blocks() &&
                image.elemSize1() == input_type_.size(),
            "OpenVinoEngine::run wants a continuous image of the network's depth and channels");
    height_ = image.rows * manifest_.input.unshuffle;
    width_ = image.cols * manifest_.input.unshuffle;
    Compiled& compiled = prepare(width_, height_);
    const bool full = with_global && full_;
    if (full && !compiled.full) {
      compiled.full = compile(*full_, this->with_global(), width_, height_);
    }
    current_ = full ? &*compiled.full : &compiled.local;
    input_ = ov::Tensor(input_type_, shape, image.data);
    current_->set_input_tensor(input_);
    infer(*current_, path_);
    global_.clear();
    if (full) global_ = values_of(current_->get_output_tensor(local_count_));
    if (with_global && manifest_.global_head) global_ = global_model_->run(features());
  }

  TensorView output(OutputRole role) const {
    require(current_ != nullptr, "OpenVinoEngine::output is called before run");
    for (std::size_t i = 0; i < local_count_; ++i) {
      const OutputSpec& spec = local_specs_[i];
      if (spec.key != key_of(role)) continue;
      const ov::Tensor tensor = current_->get_output_tensor(i);
      const int height = height_ / spec.stride;
      const int width = width_ / spec.stride;
      const float* data = tensor.data<const float>();
      const bool nchw = spec.layout == TensorLayout::kNchw && !wants_nhwc(spec);
      return nchw ? TensorView::nchw(data, spec.channels, height, width)
                  : TensorView::nhwc(data, spec.channels, height, width);
    }
    throw ContractError(fmt::format("the model has no {}", key_of(role)));
  }

  std::vector<float> global() const { return global_; }

  cv::Mat encoder() const {
    if (!global_model_) return {};
    return copy_of(manifest_.global_head ? features() : input_);
  }

  std::vector<float> global_of(const cv::Mat& encoder) const {
    if (!global_model_) return {};
    require(encoder.dims == 4 && encoder.isContinuous(),
            "the global descriptor is asked for without an encoder's output");
    return global_model_->run(as_tensor(encoder));
  }

  const std::string& precision() const { return compiler_.precision().name; }
  const std::string& cache_note() const { return compiler_.cache_note(); }

 private:
  struct Compiled {
    ov::InferRequest local;
    std::optional<ov::InferRequest> full;
  };

  const ModelFile& pick(const ModelVariants& variants) const {
    return compiler_.precision().int8 && variants.int8.given() ? variants.int8 : variants.floating;
  }

  std::shared_ptr<ov::Model> load(const ModelFile& file) const {
    std::vector<std::string> names;
    for (const OutputSpec& spec : with_features()) names.push_back(spec.name);
    if (manifest_.global) names.push_back(manifest_.global->name);
    return read_model(file, names);
  }

  /// Where one graph makes everything: with the local outputs for frames that ask for both, and
  /// by itself for images that are asked about later.
  void prepare_whole(const ov::Model& model) {
    full_ = keep_outputs(model, with_global(), path_);
    check_input(*full_, manifest_.input, path_);
    const std::shared_ptr<const ov::Model> alone = keep_outputs(model, {global_spec()}, path_);
    global_model_ = std::make_unique<VectorModel>(
        [this, alone](const ov::Shape& shape) {
          const int side = manifest_.input.unshuffle;
          return build(*alone, {global_spec()}, static_cast<int>(shape[2]) * side,
                       static_cast<int>(shape[1]) * side);
        },
        compiler_, path_);
  }

  void prepare_head() {
    const std::string path = pick(manifest_.global_head->files).path;
    const OutputSpec output{"global_head.output", manifest_.global_head->output,
                            TensorLayout::kNchw, manifest_.global_dimension, 0};
    const auto whole = read_model(pick(manifest_.global_head->files), {output.name});
    const std::shared_ptr<const ov::Model> head = keep_outputs(*whole, {output}, path);
    check_input_name(*head, manifest_.global_head->input, path);
    global_model_ = std::make_unique<VectorModel>(
        [this, head, output, path](const ov::Shape& shape) {
          return build_head(*head, output, shape, path);
        },
        compiler_, path);
  }

  ov::Tensor features() const {
    require(current_ != nullptr, "OpenVinoEngine::encoder is called before run");
    return current_->get_output_tensor(local_count_);
  }

  /// The local outputs and, for a separate global head, what that reads.
  std::vector<OutputSpec> with_features() const {
    auto specs = local_specs_;
    if (manifest_.global_head) {
      specs.push_back({kFeaturesKey, manifest_.features->name, TensorLayout::kNchw, 0, 0});
    }
    return specs;
  }

  OutputSpec global_spec() const {
    return {"outputs.global", manifest_.global->name, TensorLayout::kNchw,
            manifest_.global_dimension, 0};
  }

  std::vector<OutputSpec> with_global() const {
    auto specs = local_specs_;
    specs.push_back(global_spec());
    return specs;
  }

  Compiled& prepare(int width, int height) {
    const auto key = std::make_pair(width, height);
    const auto found = compiled_.find(key);
    if (found != compiled_.end()) return found->second;
    Compiled compiled;
    compiled.local = compile(*local_, with_features(), width, height);
    return compiled_.emplace(key, std::move(compiled)).first->second;
  }

  ov::InferRequest compile(const ov::Model& model, const std::vector<OutputSpec>& specs, int width,
                           int height) const {
    return compiler_.compile(build(model, specs, width, height), path_);
  }

  /// The model for one size of images, from the program's tensors to its tensors.
  std::shared_ptr<ov::Model> build(const ov::Model& model, const std::vector<OutputSpec>& specs,
                                   int width, int height) const {
    auto sized = model.clone();
    try {
      sized->reshape(ov::PartialShape(input_shape(manifest_.input, height, width)));
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: cannot be set to an input of {} x {} pixels: {}", path_,
                                   width, height, short_reason(e)));
    }
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (specs[i].key == kFeaturesKey) continue;
      check_output(std::as_const(*sized).output(i), specs[i], height, width, path_);
    }
    ov::preprocess::PrePostProcessor steps(sized);
    add_preprocessing(steps, manifest_.input, input_type_);
    add_postprocessing(steps, specs);
    return steps.build();
  }

  std::shared_ptr<ov::Model> build_head(const ov::Model& head, const OutputSpec& output,
                                        const ov::Shape& shape, const std::string& path) const {
    auto sized = head.clone();
    try {
      sized->reshape(ov::PartialShape(shape));
    } catch (const ov::Exception& e) {
      throw InputError(fmt::format("{}: input {} cannot take the features of shape {}: {}", path,
                                   manifest_.global_head->input,
                                   ov::PartialShape(shape).to_string(), short_reason(e)));
    }
    check_output(std::as_const(*sized).output(0), output, 0, 0, path);
    ov::preprocess::PrePostProcessor steps(sized);
    steps.output(0).tensor().set_element_type(ov::element::f32);
    return steps.build();
  }

  ModelManifest manifest_;
  ModelCompiler compiler_;
  std::vector<OutputSpec> local_specs_;
  std::size_t local_count_ = 0;
  std::string path_;
  std::shared_ptr<ov::Model> local_;
  std::shared_ptr<ov::Model> full_;
  ov::element::Type input_type_;
  std::map<std::pair<int, int>, Compiled> compiled_;
  std::unique_ptr<VectorModel> global_model_;  // reads features, or the image
  ov::InferRequest* current_ = nullptr;
  ov::Tensor input_;  // the caller's image of the last run
  int width_ = 0;     // of that, in pixels
  int height_ = 0;
  std::vector<float> global_;
};

OpenVinoEngine::OpenVinoEngine(const ModelManifest& manifest, const ExtractorOptions& options)
    : impl_(std::make_unique<Impl>(manifest, options)) {}
OpenVinoEngine::~OpenVinoEngine() = default;
void OpenVinoEngine::run(const cv::Mat& image, bool with_global) { impl_->run(image, with_global); }
TensorView OpenVinoEngine::output(OutputRole role) const { return impl_->output(role); }
std::vector<float> OpenVinoEngine::global() const { return impl_->global(); }
bool OpenVinoEngine::integer_input() const { return impl_->integer_input(); }
cv::Mat OpenVinoEngine::encoder() const { return impl_->encoder(); }
std::vector<float> OpenVinoEngine::global_of(const cv::Mat& encoder) {
  return impl_->global_of(encoder);
}
const std::string& OpenVinoEngine::precision() const { return impl_->precision(); }
const std::string& OpenVinoEngine::cache_note() const { return impl_->cache_note(); }

}  // namespace dxslam
