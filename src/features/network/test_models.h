// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <openvino/openvino.hpp>
#include <string>

namespace dxslam::testing_support {

// Small networks with random weights in the shapes of real ones, for the tests of this layer.

/// A folder of its own below the test's temporary folder, removed with the object.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// image [1,1,H,W] -> semi [1,65,H/8,W/8], desc [1,dimension,H/8,W/8]; with `features` also that,
/// [1,16,H/8,W/8].
std::shared_ptr<ov::Model> superpoint_like(int dimension, bool with_features = false);
/// What one unit of the integers of blocks_network() stands for.
constexpr double kBlocksStep = 0.05;
/// blocks [1,16,H/4,W/4], as floats or as 8-bit integers -> semi [1,65,H/8,W/8], desc
/// [1,dimension,H/8,W/8].
std::shared_ptr<ov::Model> blocks_network(int dimension, bool integer_input);
/// features [1,16,h,w] -> global_descriptor [1,dimension].
std::shared_ptr<ov::Model> global_head(int dimension);
/// image [1,H,W,1] -> scores_dense [1,H,W], local_descriptor_map [1,H/8,W/8,256] of unit length,
/// global_descriptor [1,4096]: the published HF-Net.
std::shared_ptr<ov::Model> hfnet_like();
/// image [1,3,H,W] -> dense_features [1,512,H/4,W/4].
std::shared_ptr<ov::Model> d2net_like();
/// The published HF-Net's interface as a frozen TensorFlow graph, ending in an operation that
/// cannot be converted.
std::string tensorflow_graph();

/// Writes an OpenVINO IR (.xml and .bin).
void save(const std::shared_ptr<ov::Model>& model, const std::string& xml);

/// A grey image full of corners: random rectangles, from a seed.
cv::Mat test_image(int width, int height, int seed);

}  // namespace dxslam::testing_support
