// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Networks of the shapes of real ones with random weights: what runs, and what is refused.
#include "features/network/network_extractor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "core/error.h"
#include "features/network/test_models.h"
#include "features/sha256.h"

namespace dxslam {
namespace {

using testing::HasSubstr;
using testing_support::save;
using testing_support::TemporaryFolder;
using testing_support::test_image;

ExtractorOptions exact_options() {
  ExtractorOptions options;
  options.threads = 1;
  options.deterministic = true;
  options.cache_dir = "";
  return options;
}

ModelManifest shipped_manifest(const std::string& name, const std::string& model) {
  ModelManifest manifest =
      read_model_manifest(std::string(DXSLAM_SOURCE_DIR) + "/manifests/" + name + ".yaml");
  manifest.files.floating = {model, "", ""};
  return manifest;
}

/// SuperPoint's manifest with a model of this test and no threshold, as random logits give
/// probabilities near 1/65.
ModelManifest superpoint_manifest(const TemporaryFolder& folder) {
  const std::string model = folder.file("superpoint.xml");
  if (!std::filesystem::exists(model)) save(testing_support::superpoint_like(256), model);
  ModelManifest manifest = shipped_manifest("superpoint", model);
  manifest.detector.score_threshold = 0.0;
  return manifest;
}

std::string refusal(const ModelManifest& manifest, const cv::Mat& image = test_image(64, 64, 1)) {
  try {
    make_network_extractor(manifest, exact_options())->extract(image, true);
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
    return e.what();
  }
  return "accepted";
}

void expect_sound(const Features& features, const cv::Size& size, int dimension) {
  ASSERT_EQ(features.descriptors.rows, static_cast<int>(features.size()));
  ASSERT_EQ(features.descriptors.cols, dimension);
  ASSERT_EQ(features.descriptors.type(), CV_32F);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& k = features.keypoints[i];
    EXPECT_TRUE(k.x >= 0 && k.y >= 0 && k.x <= static_cast<float>(size.width - 1) &&
                k.y <= static_cast<float>(size.height - 1));
    if (i > 0) {
      EXPECT_LE(k.score, features.keypoints[i - 1].score);
    }
    EXPECT_NEAR(cv::norm(features.descriptors.row(static_cast<int>(i))), 1.0, 1e-5);
  }
}

TEST(NetworkExtractor, RunsASuperPointLikeNetworkOnEverySizeAndKindOfImage) {
  const TemporaryFolder folder("superpoint");
  const auto extractor = make_network_extractor(superpoint_manifest(folder), exact_options());
  EXPECT_EQ(extractor->precision(), "f32");
  for (const cv::Size size : {cv::Size(96, 64), cv::Size(101, 67), cv::Size(96, 64)}) {
    const cv::Mat grey = test_image(size.width, size.height, 2);
    const Features features = extractor->extract(grey, true);
    EXPECT_GT(features.size(), 20U);
    EXPECT_TRUE(features.global.empty());
    expect_sound(features, size, 256);
    cv::Mat color;
    cv::cvtColor(grey, color, cv::COLOR_GRAY2BGR);
    EXPECT_EQ(extractor->extract(color, false).size(), features.size());
  }
}

TEST(NetworkExtractor, TakesImagesWithGapsBetweenRows) {
  const TemporaryFolder folder("gaps");
  const auto extractor = make_network_extractor(superpoint_manifest(folder), exact_options());
  const cv::Mat large = test_image(200, 100, 3);
  const cv::Mat part = large(cv::Rect(10, 10, 96, 64));
  ASSERT_FALSE(part.isContinuous());
  const Features a = extractor->extract(part, false);
  const Features b = extractor->extract(part.clone(), false);
  EXPECT_EQ(cv::norm(a.descriptors, b.descriptors, cv::NORM_INF), 0.0);
}

TEST(NetworkExtractor, KeepsKeypointsOutOfThePaddingAndTheBorder) {
  const TemporaryFolder folder("padding");
  ModelManifest manifest = superpoint_manifest(folder);
  manifest.input.size_multiple = 64;
  manifest.detector.border = 10;
  manifest.detector.subpixel = false;
  const Features features =
      make_network_extractor(manifest, exact_options())->extract(test_image(100, 70, 4), false);
  EXPECT_GT(features.size(), 10U);
  for (const Keypoint& k : features.keypoints) {
    EXPECT_TRUE(k.x >= 10 && k.y >= 10 && k.x < 90 && k.y < 60) << k.x << " " << k.y;
  }
}

TEST(NetworkExtractor, GivesTheSameBitsForAnyNumberOfThreadsAndInEveryRun) {
  const TemporaryFolder folder("threads");
  const ModelManifest manifest = superpoint_manifest(folder);
  const cv::Mat image = test_image(160, 128, 5);
  const Features first = make_network_extractor(manifest, exact_options())->extract(image, false);
  for (const int threads : {1, 2}) {
    ExtractorOptions options = exact_options();
    options.threads = threads;
    const auto extractor = make_network_extractor(manifest, options);
    for (int round = 0; round < 3; ++round) {
      const Features again = extractor->extract(image, false);
      ASSERT_EQ(again.size(), first.size());
      EXPECT_EQ(cv::norm(again.descriptors, first.descriptors, cv::NORM_INF), 0.0);
      for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(again.keypoints[i].x, first.keypoints[i].x);
        EXPECT_EQ(again.keypoints[i].score, first.keypoints[i].score);
      }
    }
  }
}

TEST(NetworkExtractor, AppliesScaleMeanAndDeviation) {
  const TemporaryFolder folder("scaling");
  ModelManifest plain = superpoint_manifest(folder);
  plain.input.scale = 1.0;
  ModelManifest scaled = plain;
  scaled.input.scale = 1.0 / 255.0;
  scaled.input.mean = {0.5};
  scaled.input.deviation = {0.25};
  const cv::Mat image = test_image(64, 64, 6);
  // (v/255 - 0.5)/0.25 = (v - 127.5)/63.75: descriptors are linear in the input, so the difference
  // of two images scales by 1/63.75 in length only.
  cv::Mat brighter = image.clone();
  brighter.setTo(200);
  const auto a = make_network_extractor(plain, exact_options());
  const auto b = make_network_extractor(scaled, exact_options());
  // On a flat image of value v every descriptor is sign(v - mean) times the kernel's sums.
  const Features pa = a->extract(brighter, false);
  const Features pb = b->extract(brighter, false);
  ASSERT_GT(pa.size(), 0U);
  ASSERT_GT(pb.size(), 0U);
  EXPECT_NEAR(pa.descriptors.row(0).dot(pb.descriptors.row(0)), 1.0, 1e-4);
  brighter.setTo(50);
  const Features dark = b->extract(brighter, false);
  EXPECT_NEAR(pa.descriptors.row(0).dot(dark.descriptors.row(0)), -1.0, 1e-4);
}

TEST(NetworkExtractor, RunsASeparateGlobalHeadOnlyWhenAsked) {
  const TemporaryFolder folder("head");
  ModelManifest manifest = superpoint_manifest(folder);
  manifest.files.floating.path = folder.file("with_features.xml");
  save(testing_support::superpoint_like(256, true), manifest.files.floating.path);
  save(testing_support::global_head(512), folder.file("head.xml"));
  manifest.features = OutputDescription{"features", TensorLayout::kNchw};
  manifest.global_head = GlobalHeadDescription{
      {{folder.file("head.xml"), "", ""}, {}}, "features", "global_descriptor"};
  manifest.global_dimension = 512;
  const auto extractor = make_network_extractor(manifest, exact_options());
  EXPECT_EQ(extractor->traits().global_dimension, 512);
  const cv::Mat image = test_image(96, 64, 7);
  const Features local = extractor->extract(image, false);
  EXPECT_TRUE(local.global.empty());
  const Features both = extractor->extract(image, true);
  ASSERT_EQ(both.global.size(), 512U);
  EXPECT_NEAR(cv::norm(both.global), 1.0, 1e-5);
  EXPECT_EQ(cv::norm(both.descriptors, local.descriptors, cv::NORM_INF), 0.0);
  const Features other = extractor->extract(test_image(128, 96, 8), true);  // another size
  EXPECT_EQ(other.global.size(), 512U);
  EXPECT_LT(std::inner_product(both.global.begin(), both.global.end(), other.global.begin(), 0.0),
            0.9999);
  EXPECT_EQ(extractor->extract(image, true).global, both.global);
  EXPECT_TRUE(extractor->extract(image, false).global.empty());

  EXPECT_TRUE(local.encoder.empty());
  extractor->keep_encoder(true);
  const Features kept = extractor->extract(image, false);
  EXPECT_TRUE(kept.global.empty());
  ASSERT_FALSE(kept.encoder.empty());
  std::vector<float> later;
  std::thread elsewhere([&] { later = extractor->global_of(kept.encoder); });
  extractor->extract(test_image(96, 64, 9), true);
  elsewhere.join();
  EXPECT_EQ(later, both.global);
  EXPECT_THROW(extractor->global_of(cv::Mat(3, 3, CV_8U)), ContractError);

  manifest.global_dimension = 256;
  EXPECT_THAT(refusal(manifest), HasSubstr("expected 256 values"));
}

TEST(NetworkExtractor, TakesNormalizedBlocksAsFloatsOrIntegers) {
  const TemporaryFolder folder("blocks");
  save(testing_support::blocks_network(32, false), folder.file("float.xml"));
  save(testing_support::blocks_network(32, true), folder.file("integer.xml"));
  ModelManifest manifest = superpoint_manifest(folder);
  manifest.input.name = "blocks";
  manifest.input.scale = 1.0;
  manifest.input.instance_normalized = true;
  manifest.input.deviation_floor = 0.25;
  manifest.input.unshuffle = 4;
  manifest.input.quantization_step = testing_support::kBlocksStep;
  manifest.descriptor.dimension = 32;
  manifest.files.floating.path = folder.file("float.xml");
  const cv::Mat image = test_image(100, 70, 21);
  const auto extractor = make_network_extractor(manifest, exact_options());
  const Features found = extractor->extract(image, false);
  EXPECT_GT(found.size(), 20U);
  expect_sound(found, image.size(), 32);
  // Brightness and contrast drop out.
  cv::Mat other;
  image.convertTo(other, -1, 0.5, 0.0);
  const Features darker = extractor->extract(other, false);
  EXPECT_NEAR(static_cast<double>(darker.size()), static_cast<double>(found.size()), 5.0);
  EXPECT_GT(found.descriptors.row(0).dot(darker.descriptors.row(0)), 0.99);

  manifest.files.floating.path = folder.file("integer.xml");
  const Features rounded = make_network_extractor(manifest, exact_options())->extract(image, false);
  EXPECT_NEAR(static_cast<double>(rounded.size()), static_cast<double>(found.size()), 5.0);
  EXPECT_GT(found.descriptors.row(0).dot(rounded.descriptors.row(0)), 0.99);

  manifest.input.quantization_step = 0.0;
  EXPECT_THAT(refusal(manifest), HasSubstr("is of type i8, expected f32"));
  manifest.input.unshuffle = 2;
  EXPECT_THAT(refusal(manifest), HasSubstr("expected [1,4,H,W]"));
}

TEST(NetworkExtractor, RunsTheOfficialHfNetInterface) {
  const TemporaryFolder folder("hfnet");
  save(testing_support::hfnet_like(), folder.file("hfnet.xml"));
  const auto extractor = make_network_extractor(
      shipped_manifest("hfnet_official", folder.file("hfnet.xml")), exact_options());
  EXPECT_EQ(extractor->traits().dimension, 256);
  EXPECT_EQ(extractor->traits().global_dimension, 4096);
  const cv::Mat image = test_image(130, 100, 9);
  const Features local = extractor->extract(image, false);
  EXPECT_GT(local.size(), 10U);
  EXPECT_TRUE(local.global.empty());
  expect_sound(local, image.size(), 256);
  const Features both = extractor->extract(image, true);
  ASSERT_EQ(both.global.size(), 4096U);
  EXPECT_NEAR(cv::norm(both.global), 1.0, 1e-5);
  EXPECT_EQ(cv::norm(both.descriptors, local.descriptors, cv::NORM_INF), 0.0);
  extractor->keep_encoder(true);
  const std::vector<float> later = extractor->global_of(extractor->extract(image, false).encoder);
  ASSERT_EQ(later.size(), 4096U);
  EXPECT_NEAR(cv::norm(cv::Mat(later), cv::Mat(both.global)), 0.0, 1e-5);
}

TEST(NetworkExtractor, CutsATensorFlowGraphBeforeWhatCannotBeConverted) {
  const TemporaryFolder folder("tensorflow");
  const std::string path = folder.file("hfnet.pb");
  std::ofstream(path, std::ios::binary) << testing_support::tensorflow_graph();
  ModelManifest manifest = shipped_manifest("hfnet_official", path);
  const auto extractor = make_network_extractor(manifest, exact_options());
  const cv::Mat image = test_image(96, 64, 10);
  const Features features = extractor->extract(image, true);
  EXPECT_GT(features.size(), 5U);
  EXPECT_EQ(features.global.size(), 4096U);
  expect_sound(features, image.size(), 256);
  manifest.descriptors.name = "local_descriptor_maps";
  EXPECT_THAT(refusal(manifest), HasSubstr("found no tensor named local_descriptor_maps"));
}

TEST(NetworkExtractor, DetectsFromTheDescriptorsOfAD2NetLikeNetwork) {
  const TemporaryFolder folder("d2net");
  save(testing_support::d2net_like(), folder.file("d2net.xml"));
  const auto extractor =
      make_network_extractor(shipped_manifest("d2net", folder.file("d2net.xml")), exact_options());
  const cv::Mat image = test_image(128, 96, 11);
  const Features features = extractor->extract(image, false);
  EXPECT_GT(features.size(), 5U);
  expect_sound(features, image.size(), 512);
}

TEST(NetworkExtractor, ObeysTheOptions) {
  const TemporaryFolder folder("options");
  const ModelManifest manifest = superpoint_manifest(folder);
  const cv::Mat image = test_image(160, 128, 12);
  const auto count = [&](const ExtractorOptions& options) {
    return make_network_extractor(manifest, options)->extract(image, false).size();
  };
  ExtractorOptions options = exact_options();
  const std::size_t all = count(options);
  options.max_keypoints = 17;
  EXPECT_EQ(count(options), 17U);
  options = exact_options();
  options.nms_radius = 1;
  EXPECT_GT(count(options), all);
  options = exact_options();
  options.score_threshold = 1.0;
  EXPECT_EQ(count(options), 0U);
  options = exact_options();
  options.precision = "int8";
  EXPECT_THROW(count(options), InputError);
  options.precision = "f64";
  EXPECT_THROW(count(options), InputError);
}

TEST(NetworkExtractor, RefusesImagesItCannotUse) {
  const TemporaryFolder folder("images");
  const ModelManifest manifest = superpoint_manifest(folder);
  EXPECT_THAT(refusal(manifest, cv::Mat()), HasSubstr("empty"));
  EXPECT_THAT(refusal(manifest, cv::Mat(64, 64, CV_16U)), HasSubstr("CV_16U"));
  EXPECT_THAT(refusal(manifest, cv::Mat(64, 20, CV_8U)), HasSubstr("20 x 64"));
}

TEST(NetworkExtractor, RefusesModelsThatDoNotFit) {
  const TemporaryFolder folder("misfits");
  const ModelManifest good = superpoint_manifest(folder);
  ASSERT_EQ(refusal(good), "accepted");

  ModelManifest manifest = good;
  manifest.files.floating.path = folder.file("missing.xml");
  EXPECT_THAT(refusal(manifest), HasSubstr("missing.xml: no such file"));

  manifest = good;
  manifest.keypoint_logits->name = "logits";
  EXPECT_THAT(refusal(manifest), HasSubstr("found outputs semi, desc, expected logits"));

  manifest = good;
  manifest.descriptor.dimension = 128;
  EXPECT_THAT(refusal(manifest), HasSubstr("[1,256,8,8]"));
  EXPECT_THAT(refusal(manifest), HasSubstr("expected [1,128,8,8]"));

  manifest = good;
  manifest.descriptor.stride = 4;
  EXPECT_THAT(refusal(manifest), HasSubstr("expected [1,256,16,16]"));

  manifest = good;
  manifest.input.channels = 3;
  EXPECT_THAT(refusal(manifest), HasSubstr("expected [1,3,H,W]"));

  manifest = good;
  manifest.input.name = "picture";
  EXPECT_THAT(refusal(manifest), HasSubstr("found inputs image, expected one called picture"));
}

TEST(NetworkExtractor, RefusesDamagedFiles) {
  const TemporaryFolder folder("damaged");
  const ModelManifest manifest = superpoint_manifest(folder);
  const std::string weights = folder.file("superpoint.bin");
  std::filesystem::resize_file(weights, std::filesystem::file_size(weights) / 2);
  EXPECT_THAT(refusal(manifest), HasSubstr("superpoint.xml"));
  std::ofstream(folder.file("superpoint.xml")) << "<?xml version=\"1.0\"?><net";
  EXPECT_THAT(refusal(manifest), HasSubstr("cannot be read as a model"));
  ModelManifest onnx = manifest;
  onnx.files.floating.path = folder.file("broken.onnx");
  std::ofstream(onnx.files.floating.path) << "not a model";
  EXPECT_THAT(refusal(onnx), HasSubstr("cannot be read as a model"));
}

TEST(NetworkExtractor, KeepsCompiledNetworksInTheCacheFolder) {
  const TemporaryFolder folder("cache");
  const ModelManifest manifest = superpoint_manifest(folder);
  ExtractorOptions options = exact_options();
  options.cache_dir = folder.file("compiled");
  const cv::Mat image = test_image(96, 64, 13);
  const Features first = make_network_extractor(manifest, options)->extract(image, false);
  EXPECT_FALSE(std::filesystem::is_empty(options.cache_dir));
  const Features second = make_network_extractor(manifest, options)->extract(image, false);
  EXPECT_EQ(cv::norm(first.descriptors, second.descriptors, cv::NORM_INF), 0.0);
}

// OpenVINO itself would use many of these: other features without a word.
TEST(NetworkExtractor, IsNotChangedByADamagedCache) {
  const TemporaryFolder folder("damaged_cache");
  const ModelManifest manifest = superpoint_manifest(folder);
  ExtractorOptions options = exact_options();
  options.cache_dir = folder.file("compiled");
  const cv::Mat image = test_image(96, 64, 13);
  const Features expected = make_network_extractor(manifest, options)->extract(image, false);
  std::vector<std::filesystem::path> files;
  for (const auto& file : std::filesystem::directory_iterator(options.cache_dir)) {
    files.push_back(file.path());
  }
  ASSERT_EQ(files.size(), 1U) << "the key must not change from start to start";
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(files[0]));
  for (int i = 0; i < 12; ++i) {
    {
      std::fstream file(files[0], std::ios::in | std::ios::out | std::ios::binary);
      const std::streamoff at = size * i / 12 + 5;
      file.seekg(at);
      const int byte = file.get();
      file.seekp(at);
      file.put(static_cast<char>(byte ^ 0x10));
    }
    const Features found = make_network_extractor(manifest, options)->extract(image, false);
    ASSERT_EQ(found.size(), expected.size()) << i;
    EXPECT_EQ(cv::norm(found.descriptors, expected.descriptors, cv::NORM_INF), 0.0) << i;
  }
}

TEST(NetworkExtractor, SaysThatItsCacheOrItsWeightsAreInDoubt) {
  const TemporaryFolder folder("notes");
  ModelManifest manifest = superpoint_manifest(folder);
  ExtractorOptions options = exact_options();
  options.cache_dir = "/proc/dxslam";
  const auto extractor = make_network_extractor(manifest, options);
  EXPECT_GT(extractor->extract(test_image(96, 64, 13), false).size(), 20U);
  EXPECT_THAT(extractor->notes(), testing::ElementsAre(HasSubstr("/proc/dxslam"),
                                                       HasSubstr("SHA-256 of a model file")));
  manifest.files.floating.sha256 = sha256_of_file(manifest.files.floating.path);
  manifest.files.floating.weights_sha256 = sha256_of_file(folder.file("superpoint.bin"));
  EXPECT_THAT(make_network_extractor(manifest, exact_options())->notes(), testing::IsEmpty());
}

}  // namespace
}  // namespace dxslam
