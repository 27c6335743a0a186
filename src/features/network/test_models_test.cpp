// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <openvino/opsets/opset13.hpp>
#include <random>

#include <unistd.h>
#include <cmath>

#include "features/network/test_models.h"

namespace dxslam::testing_support {
namespace {

namespace op = ov::opset13;
using Node = std::shared_ptr<ov::Node>;

std::vector<float> random_weights(std::size_t count, unsigned seed, float deviation) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0F, deviation);
  std::vector<float> values(count);
  for (float& v : values) v = normal(random);
  return values;
}

Node constant(const ov::Shape& shape, unsigned seed, float deviation) {
  return op::Constant::create(ov::element::f32, shape,
                              random_weights(ov::shape_size(shape), seed, deviation));
}

Node integers(const std::vector<std::int64_t>& values) {
  return op::Constant::create(ov::element::i64, ov::Shape{values.size()}, values);
}

Node scalar(float value) { return op::Constant::create(ov::element::f32, ov::Shape{}, {value}); }

/// Kernel and stride equal, no padding.
Node patches(const Node& input, std::size_t in, std::size_t out, std::size_t stride,
             unsigned seed) {
  const auto weights =
      constant({out, in, stride, stride}, seed,
               2.0F / static_cast<float>(stride) / std::sqrt(static_cast<float>(in)));
  return std::make_shared<op::Convolution>(input, weights, ov::Strides{stride, stride},
                                           ov::CoordinateDiff{0, 0}, ov::CoordinateDiff{0, 0},
                                           ov::Strides{1, 1});
}

std::shared_ptr<op::Parameter> parameter(const ov::PartialShape& shape, const std::string& name) {
  auto node = std::make_shared<op::Parameter>(ov::element::f32, shape);
  node->set_friendly_name(name);
  node->output(0).set_names({name});
  return node;
}

std::shared_ptr<op::Result> result(const Node& node, const std::string& name) {
  node->output(0).set_names({name});
  return std::make_shared<op::Result>(node);
}

Node normalized(const Node& node, std::int64_t axis) {
  return std::make_shared<op::NormalizeL2>(node, integers({axis}), 1e-12F, ov::op::EpsMode::ADD);
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::string& name)
    : path_((std::filesystem::path(::testing::TempDir()) /
             ("dxslam_" + name + "_" + std::to_string(::getpid())))
                .string()) {
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::shared_ptr<ov::Model> superpoint_like(int dimension, bool with_features) {
  const auto image = parameter({1, 1, -1, -1}, "image");
  const auto logits = patches(image, 1, 65, 8, 1);
  const auto descriptors = patches(image, 1, static_cast<std::size_t>(dimension), 8, 2);
  ov::ResultVector results{result(logits, "semi"), result(descriptors, "desc")};
  if (with_features) results.push_back(result(patches(image, 1, 16, 8, 3), "features"));
  return std::make_shared<ov::Model>(results, ov::ParameterVector{image}, "superpoint_like");
}

std::shared_ptr<ov::Model> blocks_network(int dimension, bool integer_input) {
  const auto blocks = std::make_shared<op::Parameter>(
      integer_input ? ov::element::i8 : ov::element::f32, ov::PartialShape{1, 16, -1, -1});
  blocks->set_friendly_name("blocks");
  blocks->output(0).set_names({"blocks"});
  Node values = blocks;
  if (integer_input) {
    values = std::make_shared<op::Convert>(values, ov::element::f32);
    values = std::make_shared<op::Multiply>(values, scalar(static_cast<float>(kBlocksStep)));
  }
  const auto logits = patches(values, 16, 65, 2, 12);
  const auto descriptors = patches(values, 16, static_cast<std::size_t>(dimension), 2, 13);
  return std::make_shared<ov::Model>(
      ov::ResultVector{result(logits, "semi"), result(descriptors, "desc")},
      ov::ParameterVector{blocks}, "blocks_network");
}

std::shared_ptr<ov::Model> global_head(int dimension) {
  const auto features = parameter({1, 16, -1, -1}, "features");
  const auto pooled = std::make_shared<op::ReduceMean>(features, integers({2, 3}), false);
  const auto matrix = constant({16, static_cast<std::size_t>(dimension)}, 4, 1.0F);
  const auto global = std::make_shared<op::MatMul>(pooled, matrix);
  return std::make_shared<ov::Model>(ov::ResultVector{result(global, "global_descriptor")},
                                     ov::ParameterVector{features}, "global_head");
}

std::shared_ptr<ov::Model> hfnet_like() {
  const auto image = parameter({1, -1, -1, 1}, "image");
  const auto scaled = std::make_shared<op::Multiply>(image, scalar(1.0F / 255.0F));
  const auto planar = std::make_shared<op::Transpose>(scaled, integers({0, 3, 1, 2}));
  const auto softmax = std::make_shared<op::Softmax>(patches(planar, 1, 65, 8, 5), 1);
  const auto pixels = std::make_shared<op::Slice>(softmax, integers({0}), integers({64}),
                                                  integers({1}), integers({1}));
  const auto full = std::make_shared<op::DepthToSpace>(
      pixels, op::DepthToSpace::DepthToSpaceMode::BLOCKS_FIRST, 8);
  const auto scores = std::make_shared<op::Squeeze>(full, integers({1}));
  const auto map = patches(planar, 1, 256, 8, 6);
  const auto places = std::make_shared<op::Transpose>(map, integers({0, 2, 3, 1}));
  const auto pooled = std::make_shared<op::ReduceMean>(map, integers({2, 3}), false);
  const auto global = std::make_shared<op::MatMul>(pooled, constant({256, 4096}, 7, 1.0F));
  return std::make_shared<ov::Model>(
      ov::ResultVector{result(normalized(places, 3), "local_descriptor_map"),
                       result(scores, "scores_dense"),
                       result(normalized(global, 1), "global_descriptor")},
      ov::ParameterVector{image}, "hfnet_like");
}

std::shared_ptr<ov::Model> d2net_like() {
  const auto image = parameter({1, 3, -1, -1}, "image");
  const auto scaled = std::make_shared<op::Multiply>(image, scalar(1.0F / 64.0F));
  const auto features = std::make_shared<op::Relu>(patches(scaled, 3, 512, 4, 8));
  return std::make_shared<ov::Model>(ov::ResultVector{result(features, "dense_features")},
                                     ov::ParameterVector{image}, "d2net_like");
}

namespace {

// Just enough of the protocol-buffer wire format for a TensorFlow GraphDef.
std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 128; value >>= 7) bytes += static_cast<char>(value | 128);
  return bytes + static_cast<char>(value);
}
std::string number(int field, std::int64_t value) {
  return varint(static_cast<std::uint64_t>(field) << 3) + varint(static_cast<std::uint64_t>(value));
}
std::string bytes(int field, const std::string& content) {
  return varint(static_cast<std::uint64_t>(field) << 3 | 2) + varint(content.size()) + content;
}
std::string attribute(const std::string& name, const std::string& value) {
  return bytes(5, bytes(1, name) + bytes(2, value));
}

constexpr int kFloat = 1;  // DT_FLOAT
constexpr int kInt32 = 3;  // DT_INT32

std::string type(const std::string& name, int value) { return attribute(name, number(6, value)); }
std::string integer_list(const std::string& name, const std::vector<std::int64_t>& values) {
  std::string list;
  for (const std::int64_t v : values) list += number(3, v);
  return attribute(name, bytes(1, list));
}
std::string shape(const std::vector<std::int64_t>& sizes) {
  std::string dims;
  for (const std::int64_t size : sizes) dims += bytes(2, number(1, size));
  return dims;
}
std::string node(const std::string& name, const std::string& op,
                 const std::vector<std::string>& inputs, const std::string& attributes) {
  std::string content = bytes(1, name) + bytes(2, op);
  for (const std::string& input : inputs) content += bytes(3, input);
  return bytes(1, content + attributes);
}
template <class T>
std::string tensor(const std::string& name, int kind, const std::vector<std::int64_t>& sizes,
                   const std::vector<T>& values) {
  std::string content(values.size() * sizeof(T), '\0');
  std::memcpy(content.data(), values.data(), content.size());
  return node(
      name, "Const", {},
      type("dtype", kind) + attribute("value", bytes(8, number(1, kind) + bytes(2, shape(sizes)) +
                                                            bytes(4, content))));
}
std::string convolution(const std::string& name, const std::string& input, std::int64_t out,
                        unsigned seed) {
  return tensor(name + "/weights", kFloat, {8, 8, 1, out},
                random_weights(static_cast<std::size_t>(64 * out), seed, 1e-3F)) +
         node(name, "Conv2D", {input, name + "/weights"},
              type("T", kFloat) + integer_list("strides", {1, 8, 8, 1}) +
                  attribute("padding", bytes(2, "VALID")) +
                  attribute("data_format", bytes(2, "NHWC")));
}

}  // namespace

std::string tensorflow_graph() {
  std::string graph;
  graph += node("image", "Placeholder", {},
                type("dtype", kFloat) + attribute("shape", bytes(7, shape({-1, -1, -1, 1}))));
  graph += convolution("logits", "image", 64, 9);
  graph += node("probabilities", "Softmax", {"logits"}, type("T", kFloat));
  graph += node("full", "DepthToSpace", {"probabilities"},
                type("T", kFloat) + attribute("block_size", number(3, 8)) +
                    attribute("data_format", bytes(2, "NHWC")));
  graph += node("scores_dense", "Squeeze", {"full"},
                type("T", kFloat) + integer_list("squeeze_dims", {3}));
  graph += convolution("local_descriptor_map", "image", 256, 10);
  graph += tensor<std::int32_t>("axes", kInt32, {2}, {1, 2});
  graph += node("pooled", "Mean", {"local_descriptor_map", "axes"},
                type("T", kFloat) + type("Tidx", kInt32));
  graph += tensor("matrix", kFloat, {256, 4096}, random_weights(256 * 4096, 11, 1.0F));
  graph += node("global_descriptor", "MatMul", {"pooled", "matrix"}, type("T", kFloat));
  graph += node("local_descriptors", "Resampler", {"local_descriptor_map", "scores_dense"},
                type("T", kFloat));
  return graph;
}

void save(const std::shared_ptr<ov::Model>& model, const std::string& xml) {
  ov::save_model(model, xml, false);
}

cv::Mat test_image(int width, int height, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed));
  cv::Mat image(height, width, CV_8U, cv::Scalar(128));
  for (int i = 0; i < 60 + width * height / 300; ++i) {
    const cv::Rect box(random.uniform(0, width), random.uniform(0, height), random.uniform(5, 40),
                       random.uniform(5, 40));
    cv::rectangle(image, box, cv::Scalar(random.uniform(0, 256)), cv::FILLED);
  }
  return image;
}

}  // namespace dxslam::testing_support
