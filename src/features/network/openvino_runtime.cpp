// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/openvino_runtime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <openvino/pass/serialize.hpp>
#include <sstream>
#include <streambuf>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/network/openvino_model.h"

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

Precision choose_precision(const ModelManifest& manifest, const ExtractorOptions& options,
                           const ov::Core& core) {
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
  const auto capabilities = core.get_property("CPU", ov::device::capabilities);
  const bool bf16 = std::find(capabilities.begin(), capabilities.end(),
                              ov::device::capability::BF16) != capabilities.end();
  return {false, bf16, bf16 ? "bf16" : "f32"};
}

/// A stream that keeps only a hash of what is written to it.
class HashingBuffer final : public std::streambuf {
 public:
  HashingBuffer() { XXH3_128bits_reset(state_.get()); }
  XXH128_hash_t digest() const { return XXH3_128bits_digest(state_.get()); }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    XXH3_128bits_update(state_.get(), bytes, static_cast<std::size_t>(count));
    count_ += count;
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    xsputn(&byte, 1);
    return traits_type::not_eof(c);
  }
  pos_type seekoff(off_type, std::ios_base::seekdir, std::ios_base::openmode) override {
    return count_;  // asked for to know where something was written
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
  std::streamoff count_ = 0;
};

/// All that a compiled model depends on: graph and weights, arithmetic, OpenVINO, processor. Gives
/// the nodes of the model other names.
std::string cache_key(const std::shared_ptr<ov::Model>& model, const ov::Core& core,
                      const Precision& precision, int threads) {
  // Some names count how many nodes the process has made before, which is another number each time.
  int number = 0;
  for (const auto& node : model->get_ordered_ops()) {
    node->set_friendly_name(std::to_string(number++));
  }
  HashingBuffer graph;
  HashingBuffer weights;
  std::ostream graph_stream(&graph);
  std::ostream weights_stream(&weights);
  ov::pass::Serialize(graph_stream, weights_stream).run_on_model(model);
  const XXH128_hash_t g = graph.digest();
  const XXH128_hash_t w = weights.digest();
  return fmt::format("{:x} {:x} {:x} {:x} {} {} {} {} {}", g.high64, g.low64, w.high64, w.low64,
                     precision.name, precision.bf16_allowed, threads,
                     ov::get_openvino_version().buildNumber,
                     core.get_property("CPU", ov::device::full_name));
}

int depth_of(const ov::element::Type& type) {
  if (type == ov::element::u8) return CV_8U;
  if (type == ov::element::i8) return CV_8S;
  require(type == ov::element::f32, "tensors are of u8, i8 or f32 outside of the networks");
  return CV_32F;
}

ov::element::Type type_of(int depth) {
  if (depth == CV_8U) return ov::element::u8;
  if (depth == CV_8S) return ov::element::i8;
  require(depth == CV_32F, "tensors are of u8, i8 or f32 outside of the networks");
  return ov::element::f32;
}

}  // namespace

ModelCompiler::ModelCompiler(const ModelManifest& manifest, const ExtractorOptions& options)
    : options_(options),
      core_(shared_core()),
      precision_(choose_precision(manifest, options, *core_)),
      cache_(options.cache_dir == "auto" ? cache_directory() : options.cache_dir) {}

ov::AnyMap ModelCompiler::properties() const {
  ov::AnyMap properties{ov::hint::performance_mode(ov::hint::PerformanceMode::LATENCY),
                        ov::num_streams(1), ov::inference_num_threads(options_.threads)};
  properties.insert(ov::hint::inference_precision(precision_.bf16_allowed ? ov::element::bf16
                                                                          : ov::element::f32));
  return properties;
}

// Nothing that the cache does stops a start: whatever fails with it, the model is compiled.

std::string ModelCompiler::key_of(const std::shared_ptr<ov::Model>& model) const {
  if (!cache_.usable()) return "";
  try {
    return cache_key(model, *core_, precision_, options_.threads);
  } catch (const std::exception&) {
    return "";
  }
}

std::optional<ov::InferRequest> ModelCompiler::from_cache(const std::string& key,
                                                          const ov::AnyMap& properties) const {
  if (key.empty()) return std::nullopt;
  try {
    std::optional<std::string> content = cache_.load(key);
    if (!content) return std::nullopt;
    std::istringstream stream(std::move(*content));
    return core_->import_model(stream, "CPU", properties).create_infer_request();
  } catch (const std::exception&) {  // as another build of OpenVINO wrote it
    cache_.remove(key);
    return std::nullopt;
  }
}

void ModelCompiler::into_cache(const std::string& key, ov::CompiledModel& compiled) const {
  if (key.empty()) return;
  try {
    std::ostringstream content;
    compiled.export_model(content);
    cache_.store(key, content.str());
  } catch (const std::exception&) {  // there is no room for a copy, say
  }
}

ov::InferRequest ModelCompiler::compile(const std::shared_ptr<ov::Model>& model,
                                        const std::string& path) const {
  const ov::AnyMap settings = properties();
  const std::string key = key_of(model);
  if (std::optional<ov::InferRequest> request = from_cache(key, settings)) return *request;
  try {
    ov::CompiledModel compiled = core_->compile_model(model, "CPU", settings);
    into_cache(key, compiled);
    return compiled.create_infer_request();
  } catch (const ov::Exception& e) {
    throw InputError(fmt::format("{}: cannot be compiled: {}", path, short_reason(e)));
  }
}

void infer(ov::InferRequest& request, const std::string& path) {
  try {
    request.infer();
  } catch (const ov::Exception& e) {
    throw InputError(fmt::format("{}: the network failed: {}", path, short_reason(e)));
  }
}

std::vector<float> VectorModel::run(const ov::Tensor& input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto found = requests_.find(input.get_shape());
  if (found == requests_.end()) {
    auto request = compiler_.compile(build_(input.get_shape()), path_);
    found = requests_.emplace(input.get_shape(), std::move(request)).first;
  }
  ov::InferRequest& request = found->second;
  require(request.get_compiled_model().input().get_element_type() == input.get_element_type(),
          "the global descriptor is asked for from another extractor's encoder");
  request.set_input_tensor(input);
  infer(request, path_);
  return values_of(request.get_output_tensor(0));
}

std::vector<float> values_of(const ov::Tensor& tensor) {
  const float* data = tensor.data<const float>();
  return {data, data + tensor.get_size()};
}

cv::Mat copy_of(const ov::Tensor& tensor) {
  std::vector<int> sizes;
  for (const std::size_t size : tensor.get_shape()) sizes.push_back(static_cast<int>(size));
  cv::Mat copy(sizes, depth_of(tensor.get_element_type()));
  std::memcpy(copy.data, tensor.data(), tensor.get_byte_size());
  return copy;
}

ov::Tensor as_tensor(const cv::Mat& matrix) {
  ov::Shape shape;
  for (int i = 0; i < matrix.dims; ++i) shape.push_back(static_cast<std::size_t>(matrix.size[i]));
  return {type_of(matrix.depth()), shape, matrix.data};
}

}  // namespace dxslam
