// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/stoppable_sequence.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "apps/process.h"
#include "core/parallel.h"

namespace dxslam::apps {
namespace {

// Shared with the thread that reads, which may outlive the sequence.
struct Reading {
  explicit Reading(std::unique_ptr<RgbdSequence> source) : recording(std::move(source)) {}

  const std::unique_ptr<RgbdSequence> recording;
  std::mutex mutex;
  std::condition_variable_any changed;
  // All below are guarded by mutex.
  std::optional<std::size_t> asked;
  bool answered = false;
  bool over = false;
  std::optional<RgbdImage> image;
  std::exception_ptr error;
};

void read_what_is_asked(const std::shared_ptr<Reading>& reading) {
  std::unique_lock lock(reading->mutex);
  for (;;) {
    reading->changed.wait(lock, [&] { return reading->asked || reading->over; });
    if (reading->over) return;
    const std::size_t index = *std::exchange(reading->asked, std::nullopt);
    lock.unlock();
    std::optional<RgbdImage> image;
    std::exception_ptr error;
    try {
      image = reading->recording->read(index);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    reading->image = std::move(image);
    reading->error = error;
    reading->answered = true;
    reading->changed.notify_all();
  }
}

class StoppableSequence : public RgbdSequence {
 public:
  explicit StoppableSequence(std::unique_ptr<RgbdSequence> recording)
      : reading_(std::make_shared<Reading>(std::move(recording))) {
    note_skipped();
  }

  ~StoppableSequence() override {
    {
      const std::lock_guard lock(reading_->mutex);
      reading_->over = true;
      reading_->changed.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }

  const std::string& name() const override { return reading_->recording->name(); }
  const Camera& camera() const override { return reading_->recording->camera(); }
  const RecordingFacts& facts() const override { return reading_->recording->facts(); }
  std::size_t size() const override { return reading_->recording->size(); }
  double stamp(std::size_t index) const override { return reading_->recording->stamp(index); }
  const Trajectory& ground_truth() const override { return reading_->recording->ground_truth(); }
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }

  std::optional<RgbdImage> read(std::size_t index) override {
    if (stop_requested()) return std::nullopt;
    if (!thread_.joinable()) {
      thread_ = thread_if_possible([reading = reading_] { read_what_is_asked(reading); });
    }
    if (!thread_.joinable()) return read_here(index);
    std::unique_lock lock(reading_->mutex);
    reading_->asked = index;
    reading_->answered = false;
    reading_->changed.notify_all();
    if (!reading_->changed.wait(lock, stop_token(), [&] { return reading_->answered; })) {
      thread_.detach();
      abandon_thread();
      return std::nullopt;
    }
    note_skipped();
    if (reading_->error) std::rethrow_exception(reading_->error);
    return std::exchange(reading_->image, std::nullopt);
  }

 private:
  // Without a thread nobody can stop it.
  std::optional<RgbdImage> read_here(std::size_t index) {
    std::optional<RgbdImage> image = reading_->recording->read(index);
    note_skipped();
    return image;
  }

  // A copy, for an abandoned thread may still add to the recording's own.
  void note_skipped() {
    const std::vector<SkippedFrame>& all = reading_->recording->skipped();
    skipped_.insert(skipped_.end(), all.begin() + static_cast<std::ptrdiff_t>(skipped_.size()),
                    all.end());
  }

  std::shared_ptr<Reading> reading_;
  std::thread thread_;
  std::vector<SkippedFrame> skipped_;
};

}  // namespace

std::unique_ptr<RgbdSequence> stoppable(std::unique_ptr<RgbdSequence> recording) {
  return std::make_unique<StoppableSequence>(std::move(recording));
}

}  // namespace dxslam::apps
