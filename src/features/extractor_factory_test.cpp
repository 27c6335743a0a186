// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/extractor_factory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/network/test_models.h"
#include "io/primitives/image_file.h"
#include "matching/descriptor_matching.h"

namespace dxslam {
namespace {

using testing::HasSubstr;
using testing_support::test_image;

TEST(ExtractorFactory, ListsNamesForAnUnknownOne) {
  try {
    make_extractor("nosuch");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("`nosuch`"));
    EXPECT_THAT(e.what(), HasSubstr("orb"));
    EXPECT_THAT(e.what(), HasSubstr("edgepoint2_l64"));
  }
  EXPECT_THROW(make_extractor("nosuch+brief"), InputError);
  EXPECT_THROW(make_extractor("/nonexistent/x.yaml"), InputError);
}

TEST(ExtractorFactory, RefusesOptionsOutOfRange) {
  ExtractorOptions options;
  options.threads = 0;
  EXPECT_THROW(make_extractor("orb", options), InputError);
  options = {};
  options.score_threshold = std::nan("");
  EXPECT_THROW(make_extractor("orb", options), InputError);
}

TEST(ExtractorFactory, KnowsWhichModelsAreThere) {
  const auto known = known_extractors();
  const auto available = available_extractors();
  EXPECT_EQ(known.front(), "orb");
  EXPECT_THAT(known, testing::IsSupersetOf({"superpoint", "d2net", "hfnet_official", "xfeat"}));
  EXPECT_THAT(available, testing::IsSupersetOf({"orb", "opencv_orb"}));
  EXPECT_THAT(available, testing::Not(testing::Contains("d2net")));
}

class DataDirectory : public testing::Test {
 protected:
  DataDirectory() {
    const char* const before = std::getenv("DXSLAM_DATA");
    if (before != nullptr) before_ = before;
  }
  ~DataDirectory() override {
    before_ ? ::setenv("DXSLAM_DATA", before_->c_str(), 1) : ::unsetenv("DXSLAM_DATA");
  }

 private:
  std::optional<std::string> before_;
};

TEST_F(DataDirectory, IsRefusedWhereItWasChosenAndLacksTheNetwork) {
  ::setenv("DXSLAM_DATA", "/nonexistent", 1);
  try {
    choose_extractor();
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("DXSLAM_DATA is /nonexistent"));
    EXPECT_THAT(e.what(), HasSubstr("/nonexistent/models/hfnet"));
  }
  ::unsetenv("DXSLAM_DATA");
  EXPECT_EQ(choose_extractor().name, "hfnet");
  EXPECT_EQ(choose_extractor().note, "");
}

TEST(Orb, DescribesItsKeypoints) {
  for (const char* name : {"orb", "opencv_orb"}) {
    const auto orb = make_extractor(name);
    EXPECT_EQ(orb->name(), name);
    EXPECT_TRUE(orb->traits().binary);
    const Features features = orb->extract(test_image(640, 480, 1), true);
    EXPECT_LE(features.size(), 1000U);
    EXPECT_GT(features.size(), 800U);
    ASSERT_EQ(features.descriptors.rows, static_cast<int>(features.size()));
    ASSERT_EQ(features.descriptors.cols, orb->traits().dimension);
    EXPECT_EQ(features.descriptors.type(), CV_8U);
    EXPECT_TRUE(features.global.empty());
    float largest_sigma = 0.0F;
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Keypoint& k = features.keypoints[i];
      if (i > 0) {
        EXPECT_LE(k.score, features.keypoints[i - 1].score);
      }
      const double level = std::log(static_cast<double>(k.sigma)) / std::log(1.2);
      EXPECT_NEAR(level, std::round(level), 1e-3);
      largest_sigma = std::max(largest_sigma, k.sigma);
    }
    EXPECT_NEAR(largest_sigma, std::pow(1.2F, 7.0F), 0.01F);
  }
}

/// Strong contrast on the left, faint on the right.
cv::Mat half_faint_image() {
  cv::Mat image = test_image(640, 480, 2);
  cv::Mat right = image(cv::Rect(320, 0, 320, 480));
  right.convertTo(right, CV_8U, 0.15, 110.0);
  return image;
}

TEST(Orb, ReachesFaintPartsOfTheImage) {
  const auto share_on_the_right = [](const char* name, double spread) {
    ExtractorOptions options;
    options.spread = spread;
    const Features features = make_extractor(name, options)->extract(half_faint_image(), false);
    std::size_t right = 0;
    for (const Keypoint& k : features.keypoints) right += k.x >= 330.0F ? 1U : 0U;
    return static_cast<double>(right) / static_cast<double>(features.size());
  };
  EXPECT_LT(share_on_the_right("opencv_orb", -1.0), 0.02);
  EXPECT_GT(share_on_the_right("orb", -1.0), 0.05);
  EXPECT_GT(share_on_the_right("orb", 1.0), 0.3);
}

// Turned by 180 degrees, a keypoint lies at the other end of the image, but for the pixel it is
// rounded to; coordinates that are not those of pixel centres would double their error.
TEST(Orb, PlacesKeypointsOfAllLevelsAtTheirPixels) {
  const cv::Mat image = test_image(640, 480, 1);
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_180);
  for (const char* name : {"orb", "opencv_orb"}) {
    const auto orb = make_extractor(name);
    const Features a = orb->extract(image, false);
    const Features b = orb->extract(turned, false);
    int coarse = 0;
    double x = 0.0;
    double y = 0.0;
    for (const Match& m : match_mutual(a.descriptors, b.descriptors, 40.0F, 0.8F)) {
      const Keypoint& p = a.keypoints[static_cast<std::size_t>(m.a)];
      const Keypoint& q = b.keypoints[static_cast<std::size_t>(m.b)];
      if (p.sigma < 2.5F || p.sigma != q.sigma) continue;
      ++coarse;
      x += static_cast<double>(p.x + q.x) - 639.0;
      y += static_cast<double>(p.y + q.y) - 479.0;
    }
    ASSERT_GT(coarse, 40) << name;
    EXPECT_NEAR(x / coarse, 0.0, 0.5) << name;
    EXPECT_NEAR(y / coarse, 0.0, 0.5) << name;
  }
}

TEST(Orb, ObeysTheNumberOfKeypointsAndRepeatsItself) {
  ExtractorOptions options;
  options.max_keypoints = 300;
  const cv::Mat image = test_image(640, 480, 3);
  const Features a = make_extractor("orb", options)->extract(image, false);
  const Features b = make_extractor("orb", options)->extract(image, false);
  EXPECT_EQ(a.size(), 300U);
  EXPECT_EQ(cv::norm(a.descriptors, b.descriptors, cv::NORM_INF), 0.0);
}

TEST(Brief, IgnoresBrightnessAndTurnsWithTheImageWhereOriented) {
  cv::Mat image = test_image(400, 400, 4);
  image.convertTo(image, CV_8U, 0.7, 20.0);
  cv::GaussianBlur(image, image, {}, 1.5);
  const cv::Mat brighter = image + 30;
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const auto mean_distance = [](const Features& a, const Features& b) {
    // Of matches that agree in position after the turn.
    const auto matches = match_mutual(a.descriptors, b.descriptors, 256.0F, 1.0F);
    int right = 0;
    for (const Match& m : matches) {
      const Keypoint& p = a.keypoints[static_cast<std::size_t>(m.a)];
      const Keypoint& q = b.keypoints[static_cast<std::size_t>(m.b)];
      const float x = 399.0F - p.y;  // of p in the turned image
      right += std::abs(q.x - x) < 3.0F && std::abs(q.y - p.x) < 3.0F ? 1 : 0;
    }
    return static_cast<double>(right) / static_cast<double>(a.size());
  };
  const auto upright = make_extractor("orb+brief");
  const auto oriented = make_extractor("orb+rbrief");
  EXPECT_EQ(upright->name(), "orb+brief");
  EXPECT_EQ(upright->traits().dimension, 32);
  const Features a = upright->extract(image, false);
  const Features b = upright->extract(brighter, false);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(cv::norm(a.descriptors, b.descriptors, cv::NORM_HAMMING), 0.0);
  EXPECT_LT(mean_distance(a, upright->extract(turned, false)), 0.05);
  EXPECT_GT(mean_distance(oriented->extract(image, false), oriented->extract(turned, false)), 0.4);
}

// ---- real networks, where they are at hand ----

class RealNetwork : public testing::TestWithParam<const char*> {
 protected:
  static ExtractorOptions options(int threads) {
    ExtractorOptions result;
    result.threads = threads;
    result.deterministic = true;
    result.cache_dir = "";
    return result;
  }
  static std::string frame(int number) {
    return shared_directory() + "/data/7scenes_redkitchen/frame-0000" + std::to_string(number) +
           ".color.jpg";
  }
};

TEST_P(RealNetwork, IsRepeatableAndMatchesTwoViews) {
  const std::string name = GetParam();
  const auto available = available_extractors();
  if (std::find(available.begin(), available.end(), name) == available.end()) {
    GTEST_SKIP() << "the model of " << name << " is not at hand (DXSLAM_SHARED)";
  }
  if (!std::filesystem::exists(frame(10))) GTEST_SKIP() << frame(10) << " is not at hand";
  cv::Mat first = read_color_image(frame(10));
  cv::Mat second = read_color_image(frame(20));
  if (name.rfind("alike", 0) == 0) {  // slow at full size
    first = first(cv::Rect(160, 112, 320, 256)).clone();
    second = second(cv::Rect(160, 112, 320, 256)).clone();
  }
  const auto one_thread = make_extractor(name, options(1));
  const auto two_threads = make_extractor(name, options(2));
  const Features a = one_thread->extract(first, false);
  const Features again = one_thread->extract(first, false);
  const Features threaded = two_threads->extract(first, false);
  for (const Features* other : {&again, &threaded}) {
    ASSERT_EQ(other->size(), a.size());
    EXPECT_EQ(cv::norm(other->descriptors, a.descriptors, cv::NORM_INF), 0.0);
    EXPECT_TRUE(std::equal(a.keypoints.begin(), a.keypoints.end(), other->keypoints.begin(),
                           [](const Keypoint& p, const Keypoint& q) {
                             return p.x == q.x && p.y == q.y && p.score == q.score;
                           }));
  }
  const Features b = one_thread->extract(second, false);
  const auto matches =
      match_mutual(a.descriptors, b.descriptors, one_thread->traits().max_distance, 1.0F);
  EXPECT_GT(static_cast<double>(matches.size()), 0.45 * static_cast<double>(a.size()));
}

INSTANTIATE_TEST_SUITE_P(All, RealNetwork,
                         testing::Values("hfnet", "edgepoint2_s64", "alike_t", "xfeat"));

}  // namespace
}  // namespace dxslam
