// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <openvino/openvino.hpp>
#include <string>
#include <vector>

#include "features/network/model_manifest.h"

namespace dxslam {

// Reading model files and holding them against their manifest; for openvino_engine.cpp only.

/// An output as the manifest describes it. `stride` 0 is a vector without places.
struct OutputSpec {
  std::string key;  // in the manifest
  std::string name;
  TensorLayout layout = TensorLayout::kNchw;
  int channels = 0;
  int stride = 0;

  ov::Shape expected_shape(int height, int width) const {
    const auto c = static_cast<std::size_t>(channels);
    const auto h = static_cast<std::size_t>(height / stride);
    const auto w = static_cast<std::size_t>(width / stride);
    return layout == TensorLayout::kNchw ? ov::Shape{1, c, h, w} : ov::Shape{1, h, w, c};
  }
};

/// Reads a model of any supported kind; TensorFlow graphs are cut at `outputs`, as what lies behind
/// them may be unknown to OpenVINO. Throws InputError if the file is missing, damaged, of another
/// hash or of no known kind.
std::shared_ptr<ov::Model> read_model(const ModelFile& file,
                                      const std::vector<std::string>& outputs);

/// The model that computes just these outputs, inner tensors included, in this order. It shares
/// nothing with `model`. Throws InputError for a name that is not there.
std::shared_ptr<ov::Model> keep_outputs(const ov::Model& model,
                                        const std::vector<OutputSpec>& specs,
                                        const std::string& path);

/// Throw InputError with what was found and what was expected.
void check_input_name(const ov::Model& model, const std::string& name, const std::string& path);
void check_input(const ov::Model& model, const InputDescription& input, const std::string& path);
void check_output(const ov::Output<const ov::Node>& port, const OutputSpec& spec, int height,
                  int width, const std::string& path);

/// The last line of an exception of OpenVINO, which are long and name its source files.
std::string short_reason(const std::exception& error);

}  // namespace dxslam
