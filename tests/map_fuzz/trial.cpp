// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "trial.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/error.h"
#include "map_files/map_export.h"
#include "map_files/map_merge.h"
#include "map_files/map_statistics.h"
#include "mutation.h"
#include "slam/map_weld.h"
#include "slam/stored_system.h"

namespace dxslam::fuzz {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

// What is not refused at the door must go well to the end.
template <class Action>
void must_work(const char* what, Action action) {
  try {
    action();
  } catch (const InputError& e) {
    fail(fmt::format("{}: refused late: {}", what, e.what()));
  }
}

// False where the program would refuse it, before anything is done with it.
template <class Action>
bool unless_refused(Action action) {
  try {
    action();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool is_finite(const SE3& pose) {
  return pose.translation().allFinite() && pose.rotation().coeffs().allFinite();
}

bool tracked_any(const System& system) {
  bool any = false;
  system.frames().for_each([&](const TrackedFrame& frame) {
    if (frame.state != TrackingState::kTracking) return;
    any = true;
    if (!is_finite(frame.world_from_camera)) fail("a pose that is not finite");
  });
  for (const ComponentSummary& c : system.components()) {
    for (const StampedPose& p : system.trajectory(c.component)) {
      if (!is_finite(p.world_from_camera)) fail("a trajectory that is not finite");
    }
  }
  return any;
}

class Trial {
 public:
  Trial(const BaseMaps& bases, const BaseMap& base, const std::string& folder, Chance& chance)
      : bases_(bases),
        base_(base),
        recording_(*base.recording),
        folder_(folder),
        thorough_(chance.one_in(4)),
        weld_good_first_(chance.one_in(2)) {}

  TrialReport run(const std::string& file) {
    if (!unless_refused([&] { load(file); })) return report_;
    report_.outcome = Outcome::kUsed;
    look_at(load(file));
    localize(file);
    grow(file);
    merge(file);
    return report_;
  }

 private:
  std::string path(const char* name) const { return folder_ + "/" + name; }

  StoredMap load(const std::string& bytes) const {
    return parse_map(bytes.data(), bytes.size(), "the map");
  }

  void save_and_load(const MapSnapshot& snapshot) const {
    must_work("save and load", [&] {
      save_map(path("again"), snapshot);
      load_map(path("again"));
    });
  }

  void look_at(const StoredMap& stored) const {
    must_work("statistics and export", [&] {
      map_statistics(stored);
      write_map_ply(path("map.ply"), stored.map);
      write_map_colmap(path("colmap"), stored);
    });
    std::filesystem::remove_all(path("colmap"));
    save_and_load(take_snapshot(stored.header, stored.map, stored.loops, stored.thumbnails));
  }

  // The system after these frames; null where it does not take the map.
  std::unique_ptr<System> run_system(const std::string& file, const std::string& mode,
                                     const std::vector<int>& frames) const {
    auto system = make_system(recording_, mode, !thorough_);
    const MapHeader current = map_header(system->extractor());
    const bool taken = unless_refused([&] { hand_over(load(file), *system, "the map", current); });
    if (!taken) return nullptr;
    must_work(mode.c_str(), [&] {
      for (const RgbdImage& image : images_of(recording_, frames)) system->process(image);
      system->finish();
    });
    return system;
  }

  void localize(const std::string& file) {
    const auto system = run_system(file, "localization", {2, 5, -1, 9});
    report_.localized = system != nullptr && tracked_any(*system);
  }

  void grow(const std::string& file) {
    const std::uint32_t components = load(file).map.component_count();
    const auto system = run_system(file, "slam", {1, 5, 9});
    if (system == nullptr) return;
    report_.tracked = tracked_any(*system);
    report_.joined = system->components().size() < components;
    save_and_load(take_snapshot(map_header(system->extractor()), system->map(),
                                stored_loops(system->map(), system->closed_loops())));
  }

  void merge(const std::string& file) {
    const MapSnapshot& good =
        bases_
            .maps()[base_.recording == bases_.maps().front().recording ? 0
                                                                       : bases_.maps().size() / 2]
            .snapshot;
    for (const bool good_first : {true, false}) {
      const StoredMap sound{good.header, Map(good.parts), good.loops, good.thumbnails};
      const StoredMap spoiled = load(file);
      MapSnapshot both;
      if (!unless_refused([&] {
            both = good_first ? merge_maps(sound, "a", spoiled, "b")
                              : merge_maps(spoiled, "a", sound, "b");
          })) {
        continue;
      }
      ++report_.merged;
      StoredMap merged{both.header, Map(both.parts), both.loops, both.thumbnails};
      if (thorough_ || good_first == weld_good_first_) {
        must_work("merge", [&] { weld_components(merged); });
      }
      save_and_load(take_snapshot(merged.header, merged.map, merged.loops, merged.thumbnails));
    }
  }

  const BaseMaps& bases_;
  const BaseMap& base_;
  const Recording& recording_;
  std::string folder_;
  bool thorough_;  // one in four, at twice the cost
  bool weld_good_first_;
  TrialReport report_;
};

}  // namespace

TrialReport try_case(const BaseMaps& bases, std::uint64_t seed, std::uint64_t number,
                     const std::string& folder) {
  Chance chance(seed, number);
  // Those with global descriptors twice as often: they can be localized in.
  const std::size_t half = bases.maps().size() / 2;
  const BaseMap& base = bases.maps()[chance.below(half) + (chance.one_in(3) ? half : 0)];
  const std::string file = spoiled_file(base.snapshot, chance);
  return Trial(bases, base, folder, chance).run(file);
}

}  // namespace dxslam::fuzz
