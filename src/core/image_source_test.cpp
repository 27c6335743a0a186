// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/image_source.h"

#include <gtest/gtest.h>

#include <new>
#include <set>

#include "core/error.h"

namespace dxslam {
namespace {

class Numbers : public RgbdSequence {
 public:
  const std::string& name() const override { return name_; }
  const Camera& camera() const override { return camera_; }
  const RecordingFacts& facts() const override { return facts_; }
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }
  const Trajectory& ground_truth() const override { return truth_; }
  std::size_t size() const override { return 10; }
  double stamp(std::size_t index) const override { return 0.1 * static_cast<double>(index); }
  std::optional<RgbdImage> read(std::size_t index) override {
    if (index == throws) throw std::bad_alloc();
    if (index >= silent_from) return std::nullopt;
    if (broken.count(index) > 0) {
      skipped_.push_back({index, "broken"});
      return std::nullopt;
    }
    RgbdImage image;
    image.index = static_cast<std::int64_t>(index);
    image.stamp = stamp(index);
    return image;
  }

  std::set<std::size_t> broken;
  std::size_t throws = 100;
  std::size_t silent_from = 100;

 private:
  std::string name_ = "numbers";
  Camera camera_;
  RecordingFacts facts_;
  std::vector<SkippedFrame> skipped_;
  Trajectory truth_;
};

std::vector<int> all_of(ImageSource& source) {
  std::vector<int> indices;
  while (const std::optional<RgbdImage> image = source.next()) {
    EXPECT_EQ(source.index(), static_cast<std::size_t>(image->index));
    indices.push_back(static_cast<int>(image->index));
  }
  EXPECT_FALSE(source.next().has_value());
  return indices;
}

TEST(ImageSource, GivesTheSelectedImagesOfARecording) {
  const auto source = make_image_source(std::make_unique<Numbers>(), {3, 0});
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->planned(), 4U);
  EXPECT_EQ(all_of(*source), (std::vector<int>{0, 3, 6, 9}));
  EXPECT_EQ(source->passed(), 4U);
  EXPECT_EQ(all_of(*make_image_source(std::make_unique<Numbers>(), {2, 3})),
            (std::vector<int>{0, 2, 4}));
  EXPECT_THROW(make_image_source(std::make_unique<Numbers>(), {0, 0}), ContractError);
}

TEST(ImageSource, PassesOverBrokenImages) {
  auto numbers = std::make_unique<Numbers>();
  numbers->broken = {0, 4, 6};
  const auto source = make_image_source(std::move(numbers), {2, 4});
  EXPECT_EQ(all_of(*source), (std::vector<int>{2}));
  EXPECT_EQ(source->passed(), 4U);
  EXPECT_EQ(source->skipped().size(), 3U);
}

TEST(ImageSource, GoesOnBehindAnImageThatThrew) {
  auto numbers = std::make_unique<Numbers>();
  numbers->throws = 1;
  const auto source = make_image_source(std::move(numbers), {1, 3});
  EXPECT_TRUE(source->next().has_value());
  EXPECT_THROW(source->next(), std::bad_alloc);
  EXPECT_EQ(source->index(), 1U);
  EXPECT_EQ(all_of(*source), (std::vector<int>{2}));
}

TEST(ImageSource, EndsAtTheStop) {
  const auto source = make_image_source(std::make_unique<Numbers>());
  EXPECT_TRUE(source->next().has_value());
  source->stop();
  EXPECT_TRUE(all_of(*source).empty());
  EXPECT_EQ(source->passed(), 1U);
}

TEST(ImageSource, EndsWhereTheSequenceWasStopped) {
  auto numbers = std::make_unique<Numbers>();
  numbers->silent_from = 3;
  const auto source = make_image_source(std::move(numbers));
  EXPECT_EQ(all_of(*source).size(), 3U);
  EXPECT_EQ(source->passed(), 3U);
}

}  // namespace
}  // namespace dxslam
