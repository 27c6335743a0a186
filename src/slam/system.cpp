// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system.h"

#include <utility>

#include "slam/system_engine.h"

namespace dxslam {

System::System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
               const SystemOptions& options, FrameCallback on_frame)
    : engine_(std::make_unique<SystemEngine>(camera, std::move(extractor), options,
                                             std::move(on_frame))) {}
System::~System() = default;

void System::load_map(Map map, std::vector<LoopEdge> closed_loops) {
  engine_->load_map(std::move(map), std::move(closed_loops));
}
void System::set_mapping(bool on) { engine_->set_mapping(on); }
int System::begin_sequence() { return engine_->begin_sequence(); }

void System::process(const RgbdImage& image) { engine_->process(image); }
bool System::try_process(const RgbdImage& image) { return engine_->try_process(image); }
void System::finish(const MayGoOn& may_go_on) { engine_->finish(may_go_on); }
bool System::has_failed() const { return engine_->has_failed(); }

SubscriptionPtr System::subscribe(std::size_t capacity, EventKinds kinds) {
  return engine_->events().subscribe(capacity, kinds);
}
std::optional<WholeMap> System::whole_map() { return engine_->whole_map(); }
std::optional<AllPoses> System::all_poses() { return engine_->all_poses(); }
bool System::read_map(const MapReader& read) { return engine_->read_map(read); }
EventStream& System::events() { return engine_->events(); }

const FrameLog& System::frames() const { return engine_->frames(); }
std::vector<ComponentSummary> System::components() const { return engine_->components(); }
Trajectory System::trajectory(std::optional<std::uint32_t> component) const {
  return engine_->trajectory(component);
}
Trajectory System::keyframe_trajectory(std::optional<std::uint32_t> component) const {
  return engine_->keyframe_trajectory(component);
}
bool System::map_is_whole() const { return engine_->map_is_whole(); }
const Map& System::map() const { return engine_->map(); }
const std::vector<LoopEdge>& System::closed_loops() const {
  return engine_->backend().closed_loops();
}
const LoopLog& System::loop_log() const { return engine_->backend().loop_log(); }
const std::string& System::loop_method() const { return engine_->backend().loop_method(); }
CallbackFailures System::callback_failures() const { return engine_->callback_failures(); }
const FeatureExtractor& System::extractor() const { return engine_->extractor(); }

}  // namespace dxslam
