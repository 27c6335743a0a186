// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/session.h"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <future>
#include <thread>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/recording_report.h"
#include "apps/system_setup.h"
#include "core/error.h"
#include "evaluation/openloris_result.h"
#include "evaluation/svg.h"
#include "features/extractor_factory.h"
#include "io/formats/ply_file.h"
#include "io/formats/trajectory_file.h"
#include "slam/system_setup.h"

namespace dxslam::apps {
namespace {

constexpr std::chrono::milliseconds kSlice{20};

// Everything that `run` and `lifelong` write into --out: the one replaces what the other wrote.
ResultFiles result_files() {
  ResultFiles files;
  for (const char* name : {"trajectory.txt", "trajectory_online.txt", "trajectory_map[0-9]*.txt",
                           "keyframes.txt", "online_[0-9]*.txt"}) {
    files.all.push_back({name, trajectory_kind()});
  }
  files.all.push_back({"map.ply", ply_kind()});
  files.all.push_back({"trajectory.svg", svg_kind()});
  files.all.push_back({"dxslam_*.txt", openloris_kind()});
  files.all.push_back(
      {"summary.json", json_kind("a summary of `dxslam run`", {"version", "sequence"})});
  files.all.push_back(
      {"lifelong.json", json_kind("a table of `dxslam lifelong`", {"sequence", "frames"})});
  files.last = {"summary.json", "lifelong.json"};
  files.content = {"trajectory.txt", "online_[0-9]*.txt"};
  return files;
}

// Something that is loaded in a thread of its own, for which nobody waits after a stop.
template <class Value>
class Loading {
 public:
  template <class Load>
  explicit Loading(Load load) {
    std::packaged_task<Value()> task(std::move(load));
    loaded_ = task.get_future();
    thread_ = std::thread(std::move(task));
  }
  ~Loading() { wait(); }
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  /// False at a stop; then the process ends without waiting for the thread.
  bool wait() {
    if (!thread_.joinable()) return true;
    while (loaded_.wait_for(kSlice) != std::future_status::ready) {
      if (!stop_requested()) continue;
      abandon_thread();
      thread_.detach();
      return false;
    }
    thread_.join();
    return true;
  }
  /// After wait(). Throws what loading threw.
  Value get() { return loaded_.get(); }

 private:
  std::future<Value> loaded_;
  std::thread thread_;
};

}  // namespace

Session::Session(const RunSettings& settings)
    : settings_(settings), options_(system_options_of(settings)) {}

void Session::claim_targets() {
  if (!settings_.out.empty()) folder_.emplace(settings_.out, result_files());
  if (folder_ && !settings_.map_out.empty() && folder_->claims(settings_.map_out)) {
    throw InputError(
        fmt::format("--map-out {}: is the place of a result of --out {}, expected another name",
                    settings_.map_out, settings_.out));
  }
  if (!settings_.map_out.empty()) map_target_.emplace(settings_.map_out, settings_.map_in);
  unsaved_.emplace();
}

std::unique_ptr<System> Session::start(const Camera& camera, EventReader::Function receive) {
  Loading<std::unique_ptr<FeatureExtractor>> network(
      [features = options_.features, extractor = options_.extractor] {
        return make_extractor(features, extractor);
      });
  std::optional<Loading<StoredMap>> map_in;
  if (!settings_.map_in.empty()) {
    map_in.emplace([path = settings_.map_in] { return load_map(path); });
  }
  if ((map_in && !map_in->wait()) || !network.wait()) return nullptr;
  max_depth_ = camera.max_depth;
  std::optional<StoredMap> stored;
  if (map_in) stored.emplace(map_in->get());
  if (stored) other_camera_ = says_other_camera(stored->map.rig(), camera);
  if (other_camera_) warn("{}: {}", settings_.map_in, *other_camera_);
  // It loads the vocabulary.
  Loading<std::unique_ptr<System>> made(
      [camera, extractor = network.get(), options = options_]() mutable {
        return std::make_unique<System>(camera, std::move(extractor), options);
      });
  if (!made.wait()) return nullptr;
  std::unique_ptr<System> system = made.get();
  header_ = map_header(system->extractor());
  std::vector<std::string> pictures;
  if (stored) {
    pictures = hand_over(std::move(*stored), *system, settings_.map_in, header_);
  }
  tell_notes(feature_notes(options_, system->extractor(), stored.has_value()));
  thumbnails_.emplace(settings_.thumbnails, std::move(pictures));
  if (settings_.autosave > 0) {
    saver_.emplace(*system, *map_target_, settings_.autosave, header_,
                   [this](const Map& map) { return thumbnails_->of(map); });
  }
  reader_.emplace(system->subscribe(Subscription::kUnbounded, kReceived),
                  [this, receive = std::move(receive)](const Message& message) {
                    statistics_.add(message.event);
                    receive(message);
                    note(message.event);
                  });
  system_ = system.get();
  return system;
}

void Session::note(const Event& event) {
  if (const auto* tracked = std::get_if<FrameTracked>(&event)) {
    first_pose_.note(tracked->frame);
    thumbnails_->note(tracked->frame);
  }
  if (const auto* mapped = std::get_if<KeyframeMapped>(&event)) {
    thumbnails_->note(*mapped);
    if (saver_) saver_->note(*mapped);
  }
}

void Session::run(const std::function<void()>& feed) {
  if (system_ == nullptr) return;
  for (const std::function<void()>& step : {feed, std::function<void()>([this] {
                                              system_->finish([] { return !stop_requested(); });
                                            })}) {
    try {
      step();
    } catch (...) {
      error_.keep_current();
    }
  }
  reader_->wait();  // finish() has ended what it reads
  if (saver_) saver_->finish();
}

std::optional<RgbdImage> Session::next(ImageSource& source, std::vector<SkippedFrame>& failed) {
  return next_image(source, failed,
                    [this](const SkippedFrame& skipped) { tell_unreadable(skipped); });
}

bool Session::attempt(std::size_t index, std::vector<SkippedFrame>& failed,
                      const std::function<void()>& work) {
  given_ = false;
  const auto failure = attempts_.attempt(index, work);
  if (failure && !system_->has_failed()) {
    failed.push_back(*failure);
    if (!given_) tell_unreadable(*failure);
  }
  return !stop_requested() && !system_->has_failed();
}

void Session::tell_unreadable(const SkippedFrame& skipped) {
  system_->events().publish(ImageSkipped{static_cast<std::int64_t>(skipped.index), std::nullopt,
                                         SkipReason::kUnreadable, skipped.reason});
}

bool Session::process(const RgbdImage& image, bool live) {
  given_ = true;  // what becomes of it, the system tells
  first_pose_.offer(image, max_depth_);
  thumbnails_->offer(image);
  if (live) return system_->try_process(image);
  system_->process(image);
  return true;
}

CallbackFailures Session::tell_reader_failures() const {
  if (!reader_) return {};
  const CallbackFailures failures = reader_->failures();
  if (failures.count > 0) {
    warn("{} times what goes with a frame or an autosave failed; the first: {}", failures.count,
         failures.first);
  }
  return failures;
}

std::optional<std::string> Session::why_no_pose() const {
  const bool finds_places = header_.traits.global_dimension > 0;
  auto why =
      first_pose_.why_none(options_, !settings_.map_in.empty(), finds_places, stop_requested());
  if (why && other_camera_) *why += "; " + *other_camera_;
  return why;
}

void Session::save_map(OutputSteps& steps) {
  if (settings_.map_out.empty()) return;
  if (system_ != nullptr && !system_->map_is_whole()) {
    warn("{}: not written, for an error left the map half changed{}", settings_.map_out,
         settings_.autosave > 0 ? "; the last autosave stays" : "");
    return;
  }
  if (system_ == nullptr || system_->map().keyframe_count() == 0) {
    warn("{}: not written, for the map is empty", settings_.map_out);
    return;
  }
  map_is_saved_ = steps.run([&] {
    map_target_->prepare();
    save_system_map(settings_.map_out, header_, system_->map(), system_->closed_loops(),
                    thumbnails_->of(system_->map()));
  });
}

void Session::tell_map() const {
  if (map_is_saved_) print("map in {}\n", settings_.map_out);
}

int Session::end(const OutputSteps& steps, int code) {
  code = steps.end_results(folder(), code);
  if (!map_target_) return code;
  if (code == kSuccess) map_target_->finish();
  if (const std::string kept = map_target_->kept(); !kept.empty()) {
    warn("the map of before is kept as {}", kept);
  }
  return code;
}

int judge_tracking(std::size_t tracked, std::size_t frames,
                   const std::optional<std::string>& why_no_pose) {
  if (why_no_pose) {
    warn("no frame was tracked: {}", *why_no_pose);
    return kTrackingFailed;
  }
  if (static_cast<double>(tracked) >= kLeastTrackedShare * static_cast<double>(frames)) {
    return kSuccess;
  }
  warn("only {} of {} frames were tracked", tracked, frames);
  return kTrackingFailed;
}

}  // namespace dxslam::apps
