// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/model_manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/network/test_models.h"
#include "features/sha256.h"

namespace dxslam {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

const char* const kGood = R"(format: 1
name: net
description: a network
licence: none
files:
  float: {file: net.xml}
  int8: {file: net_int8.xml}
input:
  name: image
  channels: 3
  scale: 0.5
  mean: [1, 2, 3]
  std: [4, 5, 6]
outputs:
  keypoint_logits: {name: logits}
  descriptors: {name: desc, layout: nhwc}
  features: {name: features}
global_head:
  files:
    float: {file: head.xml}
  input: features
  output: global
global_dimension: 512
detector:
  score_threshold: 0.25
  nms_radius: 3
descriptor:
  dimension: 64
info:
  anything: [1, 2]
)";

class ManifestFile {
 public:
  explicit ManifestFile(const std::string& text) : folder_("manifest") {
    std::ofstream(path()) << text;
  }
  std::string path() const { return folder_.file("net.yaml"); }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + from);
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  const ManifestFile file(text);
  try {
    read_model_manifest(file.path());
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(ModelManifest, ReadsEveryPart) {
  const ManifestFile file(kGood);
  const ModelManifest manifest = read_model_manifest(file.path());
  EXPECT_EQ(manifest.name, "net");
  EXPECT_EQ(manifest.files.floating.path, file.folder().file("net.xml"));
  EXPECT_TRUE(manifest.has_int8());
  EXPECT_EQ(manifest.input.channels, 3);
  EXPECT_THAT(manifest.input.mean, testing::ElementsAre(1.0, 2.0, 3.0));
  EXPECT_EQ(manifest.descriptors.layout, TensorLayout::kNhwc);
  EXPECT_EQ(manifest.global_head->files.floating.path, file.folder().file("head.xml"));
  EXPECT_EQ(manifest.global_dimension, 512);
  EXPECT_EQ(manifest.detector.nms_radius, 3);
  EXPECT_DOUBLE_EQ(manifest.detector.score_threshold, 0.25);
  EXPECT_EQ(manifest.detector.max_keypoints, DetectorOptions().max_keypoints);
  EXPECT_EQ(manifest.descriptor.dimension, 64);
}

TEST(ModelManifest, ReadsUnshuffledInput) {
  std::string text = replaced("scale: 0.5\n  mean: [1, 2, 3]\n  std: [4, 5, 6]\n",
                              "normalization: instance\n  unshuffle: 4\n"
                              "  deviation_floor: 0.25\n  quantization_step: 0.05\n");
  text.replace(text.find("channels: 3"), 11, "channels: 1");
  const ManifestFile file(text);
  const InputDescription input = read_model_manifest(file.path()).input;
  EXPECT_TRUE(input.instance_normalized);
  EXPECT_EQ(input.blocks(), 16);
  EXPECT_DOUBLE_EQ(input.deviation_floor, 0.25);
  EXPECT_DOUBLE_EQ(input.quantization_step, 0.05);
}

TEST(ModelManifest, NamesFileLineAndFaultOfWhatItRefuses) {
  struct Case {
    const char* from;
    const char* to;
    const char* expected;
  };
  const Case cases[] = {
      {"format: 1", "format: 2", "`format` is 2, expected 1"},
      {"name: net\n", "", "`name` is missing"},
      {"channels: 3", "channels: 2", "expected 1 or 3"},
      {"channels: 3", "channels: three", "'three', expected a whole number"},
      {"mean: [1, 2, 3]", "mean: [1, 2]", "`mean` has 2 numbers, expected 3"},
      {"std: [4, 5, 6]", "std: [4, 0, 6]", "`std` has 0, expected above 0"},
      {"scale: 0.5", "unshuffle: 4", "expected one channel and `normalization: instance`"},
      {"scale: 0.5", "quantization_step: 0.1", "expected `unshuffle` with it"},
      {"  nms_radius: 3", "  nms_radios: 3", "did you mean 'detector.nms_radius'"},
      {"nms_radius: 3", "nms_radius: 300", "from 0 to 64 pixels"},
      {"layout: nhwc", "layout: hwc", "expected nchw or nhwc"},
      {"  keypoint_logits: {name: logits}\n", "", "found 0 sources of keypoints"},
      {"  keypoint_logits:", "  scores: {name: s}\n  keypoint_logits:", "found 2 sources"},
      {"  dimension: 64", "  stride: 8", "`dimension` is missing"},
      {"  dimension: 64", "  dimension: 64\n  stride: 5",
       "expected a multiple of descriptor.stride"},
      {"global_dimension: 512", "global_dimension: 0", "the length of the global descriptor"},
      {"  features: {name: features}\n", "", "outputs.features is missing"},
      {"{file: net.xml}", "{file: net.xml, sha256: abc}", "64 lower-case hexadecimal digits"},
      {"  float: {file: net.xml}\n", "", "`float` is missing"},
      {"licence: none", "licence: [", "not valid YAML"},
  };
  for (const Case& c : cases) {
    const std::string message = refusal(replaced(c.from, c.to));
    EXPECT_THAT(message, HasSubstr(c.expected)) << c.to;
    EXPECT_THAT(message, HasSubstr("net.yaml:")) << c.to;
  }
}

TEST(ModelManifest, RefusesAMissingFile) {
  EXPECT_THROW(read_model_manifest("/nonexistent/manifest.yaml"), InputError);
}

TEST(ModelManifest, FillsInTheSharedFolder) {
  const char* before = std::getenv("DXSLAM_SHARED");
  const std::string saved = before == nullptr ? "" : before;
  ::setenv("DXSLAM_SHARED", "/somewhere", 1);
  EXPECT_EQ(expand_variables("${DXSLAM_SHARED}/a.onnx"), "/somewhere/a.onnx");
  EXPECT_EQ(expand_variables("a.onnx"), "a.onnx");
  ::unsetenv("DXSLAM_SHARED");
  EXPECT_THAT(expand_variables("${DXSLAM_SHARED}/a.onnx"), testing::EndsWith("shared/a.onnx"));
  if (!saved.empty()) ::setenv("DXSLAM_SHARED", saved.c_str(), 1);
}

TEST(ModelManifest, VerifiesHashesOfModelAndWeights) {
  const TemporaryFolder folder("hashes");
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(folder.file(name), std::ios::binary) << text;
  };
  ModelFile file;
  file.path = folder.file("m.xml");
  const auto message = [&]() -> std::string {
    try {
      verify_model_file(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(), HasSubstr("no such file"));
  write("m.xml", "model");
  EXPECT_THAT(message(), HasSubstr("expected the weights"));
  write("m.bin", "weights");
  EXPECT_EQ(message(), "accepted");
  file.sha256 = sha256("model", 5);
  file.weights_sha256 = sha256("weights", 7);
  EXPECT_EQ(message(), "accepted");
  write("m.bin", "weight");
  EXPECT_THAT(message(), HasSubstr("m.bin: has SHA-256"));
  EXPECT_THAT(message(), HasSubstr("(6 bytes), expected " + file.weights_sha256));
  write("m.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 7\n");
  EXPECT_THAT(message(), HasSubstr("m.bin: no model; it is only a pointer of Git LFS"));
  std::filesystem::remove(folder.file("m.xml"));
  ASSERT_EQ(::mkfifo(folder.file("m.xml").c_str(), 0600), 0);  // which nobody writes to
  EXPECT_THAT(message(), HasSubstr("m.xml: not a regular file"));
}

TEST(ModelManifest, AllShippedManifestsAreValid) {
  int count = 0;
  const std::filesystem::path source(DXSLAM_SOURCE_DIR);
  for (const auto& entry : std::filesystem::directory_iterator(source / "manifests")) {
    if (entry.path().extension() != ".yaml") continue;
    const ModelManifest manifest = read_model_manifest(entry.path().string());
    EXPECT_EQ(manifest.name, entry.path().stem().string());
    ++count;
  }
  EXPECT_GE(count, 9);
}

}  // namespace
}  // namespace dxslam
