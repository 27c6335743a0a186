// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "features/extractor_options.h"
#include "features/network/model_manifest.h"
#include "features/network/tensor_view.h"

namespace dxslam {

enum class OutputRole { kKeypointLogits, kScores, kDescriptors, kReliability };

/// Runs the networks of one manifest by OpenVINO on the processor; this and
/// openvino_model.h are all that knows OpenVINO. Models are OpenVINO IR, ONNX, or TensorFlow
/// (frozen graph or saved model, cut at the outputs that the manifest names, so that what lies
/// behind them need not be supported). They are compiled once a size with static shapes. One thread
/// at a time, global_of() aside.
class OpenVinoEngine {
 public:
  /// Loads and checks the model files: existence, hash, names and shapes of input and outputs.
  /// Throws InputError saying what was found and what was expected.
  OpenVinoEngine(const ModelManifest& manifest, const ExtractorOptions& options);
  ~OpenVinoEngine();

  /// Whether the network takes 8-bit integers in place of normalised values (NetworkInput).
  bool integer_input() const;

  /// `image` is what NetworkInput makes: continuous, CV_8U (CV_32F where the manifest normalises
  /// each image, CV_8S where integer_input), with the manifest's number of channels (BGR where
  /// three; blocks where it unshuffles), of the fixed size or multiples of size_multiple. The part
  /// that makes the global descriptor runs only `with_global`. The first image of a size compiles
  /// the network for it.
  void run(const cv::Mat& image, bool with_global);

  /// Output of the last run(); valid until the next.
  TensorView output(OutputRole role) const;
  /// Raw global descriptor of the last run(with_global = true).
  std::vector<float> global() const;

  /// What global_of() needs of the last run(): a copy of the features that the global head reads,
  /// or of the image where the whole network makes the descriptor. Empty without such.
  cv::Mat encoder() const;
  /// Raw global descriptor from a former run()'s encoder(). May be called while another thread is
  /// inside any other function; calls of it wait for one another.
  std::vector<float> global_of(const cv::Mat& encoder);

  /// As ModelCompiler::cache_note().
  const std::string& cache_note() const;

  /// Precision that runs: "int8", "f32" or "bf16".
  const std::string& precision() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dxslam
