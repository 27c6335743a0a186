// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <openvino/openvino.hpp>
#include <optional>
#include <string>
#include <vector>

#include "features/extractor_options.h"
#include "features/network/model_cache.h"
#include "features/network/model_manifest.h"

namespace dxslam {

// Compiling and running models; for openvino_engine.cpp only.

/// Which variant of a model runs, and what arithmetic its float layers use.
struct Precision {
  bool int8 = false;
  bool bf16_allowed = false;
  std::string name;  // int8, f32 or bf16
};

/// Compiles models alike: precision, threads and cache. Any number of threads at a time.
class ModelCompiler {
 public:
  /// Throws InputError where the manifest has no model of the precision asked for.
  ModelCompiler(const ModelManifest& manifest, const ExtractorOptions& options);

  const Precision& precision() const { return precision_; }
  /// Why compiled models are not kept, if they cannot be; "" otherwise.
  const std::string& cache_note() const { return cache_.note(); }
  /// `path` is for the message of the InputError thrown if it fails.
  ov::InferRequest compile(const std::shared_ptr<ov::Model>& model, const std::string& path) const;

 private:
  ov::AnyMap properties() const;
  std::string key_of(const std::shared_ptr<ov::Model>& model) const;
  std::optional<ov::InferRequest> from_cache(const std::string& key,
                                             const ov::AnyMap& properties) const;
  void into_cache(const std::string& key, ov::CompiledModel& compiled) const;

  ExtractorOptions options_;
  std::shared_ptr<ov::Core> core_;
  Precision precision_;
  ModelCache cache_;
};

/// Throws InputError if the network fails.
void infer(ov::InferRequest& request, const std::string& path);

/// A model with one input and a vector as its output, compiled once for each shape of the input.
/// Callable from any thread; calls wait for one another.
class VectorModel {
 public:
  /// The model for inputs of a shape.
  using Build = std::function<std::shared_ptr<ov::Model>(const ov::Shape&)>;
  VectorModel(Build build, const ModelCompiler& compiler, std::string path)
      : build_(std::move(build)), compiler_(compiler), path_(std::move(path)) {}

  std::vector<float> run(const ov::Tensor& input);

 private:
  Build build_;
  const ModelCompiler& compiler_;
  std::string path_;
  std::mutex mutex_;
  std::map<ov::Shape, ov::InferRequest> requests_;
};

/// The values of a tensor of floats.
std::vector<float> values_of(const ov::Tensor& tensor);

/// A copy of a tensor as a matrix with the same axes, and the tensor that such a matrix holds the
/// memory of. u8, i8 and f32.
cv::Mat copy_of(const ov::Tensor& tensor);
ov::Tensor as_tensor(const cv::Mat& matrix);

}  // namespace dxslam
