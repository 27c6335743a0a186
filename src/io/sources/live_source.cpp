// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/live_source.h"

#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/error.h"
#include "io/recordings/depth_registration.h"
#include "io/recordings/depth_survey.h"
#include "io/sources/stream_pairing.h"

namespace dxslam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = 4;
constexpr std::size_t kMostSkipped = 1000;
constexpr std::chrono::milliseconds kSlice{50};  // how long a stop may take

class LiveSource : public ImageSource {
 public:
  LiveSource(std::string name, std::unique_ptr<LiveCamera> camera, const ImageSelection& selection,
             const LiveOptions& options)
      : name_(std::move(name)),
        source_(std::move(camera)),
        selection_(selection),
        options_(options),
        camera_(source_->calibration().camera),
        pairing_(source_->has_depth(), options.max_association_s) {
    require(selection.stride > 0, "a stride is at least 1");
    camera_.prepare(source_->calibration_source());
    if (const DepthCamera& depth = source_->calibration().depth_camera; !depth.registered()) {
      registration_.emplace(camera_, depth);
    }
    facts_.calibration_source = source_->calibration_source();
    facts_.has_depth = source_->has_depth();
    reader_ = std::thread([this] { read_pictures(); });
  }
  ~LiveSource() override {
    stop();
    reader_.join();
  }

  const std::string& name() const override { return name_; }
  const Camera& camera() const override { return camera_; }
  const RecordingFacts& facts() const override { return facts_; }
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }
  const Trajectory& ground_truth() const override { return truth_; }
  bool is_live() const override { return true; }
  std::optional<std::size_t> planned() const override { return std::nullopt; }
  std::size_t passed() const override { return passed_; }
  std::size_t index() const override { return passed_ == 0 ? 0 : passed_ - 1; }
  std::size_t dropped() const override {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }
  void stop() override {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  std::optional<RgbdImage> next() override {
    if (first_) return std::exchange(first_, std::nullopt);
    while (selection_.most == 0 || passed_ < selection_.most) {
      std::optional<PicturePair> pair = wait_for_pair();
      if (!pair) return std::nullopt;
      if (taken_++ % selection_.stride != 0) continue;
      ++passed_;
      try {
        return image_of(std::move(*pair));
      } catch (const InputError& e) {
        if (skipped_.size() < kMostSkipped) skipped_.push_back({index(), e.what()});
      }
    }
    stop();
    return std::nullopt;
  }

  /// Takes the first image, so that facts() can tell of it.
  void open() {
    first_ = next();
    if (first_ && !first_->depth.empty()) survey_depths({first_->depth}, facts_);
    if (first_) check_depth_scale(name_, camera_, facts_);
  }

 private:
  void read_pictures() {
    try {
      Clock::time_point heard = Clock::now();
      while (!is_stopped()) {
        std::optional<LivePicture> picture = source_->next(kSlice);
        if (picture) {
          heard = Clock::now();
          pairing_.add(std::move(*picture));
          hand_over();
          require_pairs();
        } else if (Clock::now() - heard > options_.silence) {
          throw InputError(fmt::format(
              "{}: no image for {:g} s, expected a camera that is plugged in and used by no other "
              "program",
              name_, seconds(options_.silence)));
        }
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      changed_.notify_all();
    }
  }

  static double seconds(std::chrono::milliseconds time) {
    return std::chrono::duration<double>(time).count();
  }

  // Colour without depth, or the other way round, is as good as silence.
  void require_pairs() const {
    if (pairing_.alone() < seconds(options_.silence)) return;
    if (pairing_.nearest() > 0.0 && !pairing_.has_paired()) {
      throw InputError(fmt::format(
          "{}: colour and depth are {:.3g} s apart at best, expected less than {:g} s: two streams "
          "of one clock",
          name_, pairing_.nearest(), options_.max_association_s));
    }
    throw InputError(fmt::format("{}: no depth image to colour for {:g} s, expected both streams",
                                 name_, seconds(options_.silence)));
  }

  void hand_over() {
    std::vector<PicturePair> pairs = pairing_.take_pairs();
    std::vector<std::string> problems = pairing_.take_problems();
    const std::lock_guard lock(mutex_);
    for (PicturePair& pair : pairs) waiting_.push_back(std::move(pair));
    for (; waiting_.size() > kMostWaiting; waiting_.pop_front()) ++dropped_;
    for (std::string& problem : problems) {
      if (problems_.size() < kMostSkipped) problems_.push_back(std::move(problem));
    }
    changed_.notify_all();
  }

  bool is_stopped() const {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }

  // Nothing after the stop.
  std::optional<PicturePair> wait_for_pair() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || error_ || !waiting_.empty(); });
    for (std::string& problem : std::exchange(problems_, {})) {
      if (skipped_.size() < kMostSkipped) skipped_.push_back({passed_, std::move(problem)});
    }
    if (stopped_) return std::nullopt;
    if (!waiting_.empty()) {
      PicturePair pair = std::move(waiting_.front());
      waiting_.pop_front();
      return pair;
    }
    stopped_ = true;  // the error is told once
    std::rethrow_exception(error_);
  }

  RgbdImage image_of(PicturePair pair) const {
    const cv::Size size(camera_.width, camera_.height);
    require_size(pair.color, size, "colour");
    RgbdImage image;
    image.index = static_cast<std::int64_t>(index());
    image.stamp = pair.stamp;
    image.color = std::move(pair.color);
    if (pair.raw_depth.empty()) return image;
    require_size(pair.raw_depth, registration_ ? registration_->raw_size() : size, "depth");
    if (registration_) pair.raw_depth = (*registration_)(pair.raw_depth);
    pair.raw_depth.convertTo(image.depth, CV_32F, 1.0 / camera_.depth_factor);
    return image;
  }

  void require_size(const cv::Mat& image, cv::Size size, const char* what) const {
    if (image.size() == size) return;
    throw InputError(fmt::format("{}: a {} image of {}x{}, expected {}x{} as {} says", name_, what,
                                 image.cols, image.rows, size.width, size.height,
                                 facts_.calibration_source));
  }

  std::string name_;
  std::unique_ptr<LiveCamera> source_;
  ImageSelection selection_;
  LiveOptions options_;
  Camera camera_;
  std::optional<DepthRegistration> registration_;
  RecordingFacts facts_;
  Trajectory truth_;
  std::vector<SkippedFrame> skipped_;
  std::optional<RgbdImage> first_;
  std::size_t passed_ = 0;
  std::size_t taken_ = 0;  // of the camera, with those between two strides
  StreamPairing pairing_;  // of the thread alone
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // All below are guarded by mutex_.
  std::deque<PicturePair> waiting_;
  std::vector<std::string> problems_;
  std::size_t dropped_ = 0;
  bool stopped_ = false;
  std::exception_ptr error_;
  std::thread reader_;
};

}  // namespace

std::unique_ptr<ImageSource> make_live_source(const std::string& name,
                                              std::unique_ptr<LiveCamera> camera,
                                              const ImageSelection& selection,
                                              const LiveOptions& options) {
  require(camera != nullptr, "a live source needs a camera");
  auto source = std::make_unique<LiveSource>(name, std::move(camera), selection, options);
  source->open();
  return source;
}

}  // namespace dxslam
