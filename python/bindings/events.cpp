// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/events.h"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/shutdown.h"
#include "bindings/tables.h"

namespace dxslam::python {
namespace {

// What all events have; the message is shared with all who read it.
struct AnyEvent {
  MessagePtr message;
};

// Of one class: what Python sees of `T`.
template <class T>
struct EventOf : AnyEvent {
  const T& get() const { return std::get<T>(message->event); }
};

// How fields of events look in Python.
template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
Number shown(const MessagePtr&, const Number& value) {
  return value;
}
std::optional<std::uint32_t> shown(const MessagePtr&, const std::uint32_t& id) {
  return id == kNoId ? std::nullopt : std::optional(id);
}
std::string shown(const MessagePtr&, const std::string& text) { return text; }
LossReason shown(const MessagePtr&, const LossReason& reason) { return reason; }
SkipReason shown(const MessagePtr&, const SkipReason& reason) { return reason; }
MappingReport shown(const MessagePtr&, const MappingReport& report) { return report; }
std::optional<double> shown(const MessagePtr&, const std::optional<double>& value) { return value; }
std::optional<Array<double, 6, 6>> shown(const MessagePtr&, const std::optional<Matrix6d>& matrix) {
  return matrix ? std::optional(to_array(*matrix)) : std::nullopt;
}
TrackedFrame shown(const MessagePtr&, const TrackedFrame& frame) { return frame; }
Array<double, 4, 4> shown(const MessagePtr&, const SE3& pose) { return to_array(pose); }
Array<std::uint32_t, -1> shown(const MessagePtr&, const std::vector<std::uint32_t>& ids) {
  return to_array<Array<std::uint32_t, -1>>(ids, {ids.size()});
}
KeyframeTable shown(const MessagePtr& message, const std::vector<KeyframePose>& rows) {
  return {{message, &rows}};
}
PointTable shown(const MessagePtr& message, const std::vector<PointPosition>& rows) {
  return {{message, &rows}};
}

// Binds one event: its class, then its fields.
template <class T>
class EventClass {
 public:
  EventClass(nb::module_& m, const char* name, const char* doc) : class_(m, name, doc) {}
  ~EventClass() { class_.attr("__match_args__") = nb::tuple(names_); }
  EventClass(const EventClass&) = delete;
  EventClass& operator=(const EventClass&) = delete;

  template <class Field>
  EventClass& field(const char* name, Field T::* member, const char* doc) {
    class_.def_prop_ro(
        name,
        [member](const EventOf<T>& event) { return shown(event.message, event.get().*member); },
        kOwned, doc);
    names_.append(name);
    return *this;
  }

 private:
  nb::class_<EventOf<T>, AnyEvent> class_;
  nb::list names_;
};

void bind_run_events(nb::module_& m) {
  EventClass<RecordingBegun>(m, "RecordingBegun", "Images from now on are of this recording.")
      .field("recording", &RecordingBegun::number, "Which, from 0.");
  EventClass<RecordingEnded>(m, "RecordingEnded", "All keyframes of a recording are in the map.")
      .field("recording", &RecordingEnded::number, "Which, from 0.")
      .field("keyframes", &RecordingEnded::keyframes, "Of the whole map now.")
      .field("points", &RecordingEnded::points, "Of the whole map now.");
  EventClass<MapSaved>(m, "MapSaved", "The map was written, whole, to a file.")
      .field("path", &MapSaved::path, "The file.");
  EventClass<RunFinished>(m, "RunFinished", "The run has ended well; nothing follows.")
      .field("final_bundle_ms", &RunFinished::final_bundle_ms,
             "The last adjustment of the whole map, milliseconds.");
  EventClass<RunFailed>(m, "RunFailed", "The run has ended with an error; nothing follows.")
      .field("what", &RunFailed::what, "One sentence.");
}

void bind_frame_events(nb::module_& m) {
  EventClass<FrameTracked>(m, "FrameTracked",
                           "Tracking has worked on a frame, found its pose or not.")
      .field("frame", &FrameTracked::frame, "What it found.")
      .field("covariance", &FrameTracked::covariance,
             "(6, 6) float64 of the pose, translation in metres before rotation in radians, along "
             "the axes of the camera; errors of the map are not in it. None without a pose, and "
             "for the frame that begins a map.")
      .field("extract_ms", &FrameTracked::extract_ms, "Milliseconds.")
      .field("track_ms", &FrameTracked::track_ms,
             "Milliseconds, looking for its place in the map included.")
      .field("relocalize_ms", &FrameTracked::relocalize_ms,
             "Of it, looking for the place; None where it was not looked for.")
      .field("request_dropped", &FrameTracked::request_dropped,
             "It should have become a keyframe, but mapping was too far behind.");
  EventClass<ImageSkipped>(m, "ImageSkipped", "An image that there is no FrameTracked of.")
      .field("index", &ImageSkipped::index, "Of the image.")
      .field("stamp", &ImageSkipped::stamp, "Seconds; None where it is not known.")
      .field("reason", &ImageSkipped::reason, "Why.")
      .field("what", &ImageSkipped::what, "One sentence, where there is more to say.");
  EventClass<TrackingLost>(m, "TrackingLost",
                           "The first frame without a pose, of a recording or after one that had "
                           "one.")
      .field("stamp", &TrackingLost::stamp, "Seconds.")
      .field("reason", &TrackingLost::reason, "Why.")
      .field("keypoints", &TrackingLost::keypoints, "Of the frame.")
      .field("matches", &TrackingLost::matches, "Known points found in it, at most.");
  EventClass<PlaceFound>(m, "PlaceFound", "A frame was found in the map by itself.")
      .field("stamp", &PlaceFound::stamp, "Seconds.")
      .field("component", &PlaceFound::component, "Of the map, in whose world the pose is.")
      .field("reference", &PlaceFound::reference, "Id of the keyframe that shares most points.")
      .field("world_from_camera", &PlaceFound::world_from_camera, "(4, 4) float64, metres.")
      .field("confidence", &PlaceFound::confidence, "Probability that it is right, 0 to 1.");
}

void bind_map_events(nb::module_& m) {
  EventClass<KeyframeMapped>(m, "KeyframeMapped", "A keyframe was worked into the map.")
      .field("frame", &KeyframeMapped::frame, "Index of its image.")
      .field("report", &KeyframeMapped::report, "What that changed.")
      .field("insert_ms", &KeyframeMapped::insert_ms, "Milliseconds.")
      .field("refine_ms", &KeyframeMapped::refine_ms, "Milliseconds.")
      .field("loop_closing_ms", &KeyframeMapped::loop_closing_ms, "Milliseconds.");
  EventClass<MapChanged>(m, "MapChanged",
                         "What one step of mapping did to the map. Together these give the whole "
                         "map; who comes late begins with System.whole_map().")
      .field("added_keyframes", &MapChanged::added_keyframes, "New ones.")
      .field("moved_keyframes", &MapChanged::moved_keyframes, "Those with a new pose.")
      .field("removed_keyframes", &MapChanged::removed_keyframes, "(N,) uint32, ids.")
      .field("added_points", &MapChanged::added_points, "New ones.")
      .field("moved_points", &MapChanged::moved_points, "Those with a new position.")
      .field("removed_points", &MapChanged::removed_points, "(N,) uint32, ids.")
      .field("is_correction", &MapChanged::is_correction,
             "Poses given before are not what the map says now: a loop was closed, or maps were "
             "joined.");
  EventClass<LoopFound>(m, "LoopFound", "A keyframe looks like one from before.")
      .field("query", &LoopFound::query, "Id of the new keyframe.")
      .field("candidate", &LoopFound::candidate, "Id of the one that may see the same place.")
      .field("bow_score", &LoopFound::bow_score, "Of words, 0 to 1.")
      .field("global_distance", &LoopFound::global_distance,
             "Of global descriptors; None where there are none.");
  EventClass<LoopRefused>(m, "LoopRefused", "It is not the same place, or cannot be.")
      .field("query", &LoopRefused::query, "Id of the new keyframe.")
      .field("candidate", &LoopRefused::candidate, "Id of the other.")
      .field("reason", &LoopRefused::reason, "Why not.");
  EventClass<LoopClosed>(m, "LoopClosed", "It is the same place; MapChanged follows.")
      .field("query", &LoopClosed::query, "Id of the new keyframe.")
      .field("candidate", &LoopClosed::candidate, "Id of the one that sees the same place.")
      .field("largest_move", &LoopClosed::largest_move,
             "Of a keyframe, metres; 0 where the map agreed already.");
  EventClass<MapsJoined>(m, "MapsJoined", "It is, and two components are one from now on.")
      .field("query", &MapsJoined::query, "Id of the new keyframe.")
      .field("candidate", &MapsJoined::candidate, "Id of the one that sees the same place.")
      .field("kept_component", &MapsJoined::kept_component, "What both are now.")
      .field("joined_component", &MapsJoined::joined_component, "What is no more.");
}

// The tables of all events.
void bind_all_events(nb::module_& m) {
  static_assert(std::variant_size_v<Event> == 15, "a new event wants a row above");
  bind_run_events(m);
  bind_frame_events(m);
  bind_map_events(m);
}

void bind_report(nb::module_& m) {
  nb::enum_<SkipReason>(m, "SkipReason", "Why an image was not worked on.")
      .value("UNREADABLE", SkipReason::kUnreadable, "It could not be read.")
      .value("NOT_EXTRACTED", SkipReason::kNotExtracted, "Its features could not be extracted.")
      .value("DROPPED", SkipReason::kDropped, "Tracking was too far behind.");
  nb::class_<MappingReport>(m, "MappingReport", "What one keyframe changed. Immutable.")
      .def_ro("keyframe", &MappingReport::keyframe, "Its id.")
      .def_ro("new_points", &MappingReport::new_points, "Made from depth.")
      .def_ro("triangulated_points", &MappingReport::triangulated_points, "Made without depth.")
      .def_ro("fused_points", &MappingReport::fused_points, "That were others'.")
      .def_ro("culled_points", &MappingReport::culled_points, "Removed.")
      .def_ro("culled_keyframes", &MappingReport::culled_keyframes, "Ids of those removed.");
}

void bind_frame(nb::module_& m) {
  nb::enum_<TrackingState>(m, "TrackingState", "What tracking knows of a frame.")
      .value("NOT_STARTED", TrackingState::kNotStarted, "There is no map yet.")
      .value("TRACKING", TrackingState::kTracking, "It has a pose.")
      .value("LOST", TrackingState::kLost, "It has no pose.");
  nb::enum_<LossReason>(m, "LossReason", "Why a frame has no pose.")
      .value("FEW_KEYPOINTS", LossReason::kFewKeypoints, "It shows too few keypoints.")
      .value("FEW_DEPTHS", LossReason::kFewDepths,
             "Too few have a depth: no map can begin with it.")
      .value("FEW_MATCHES", LossReason::kFewMatches, "Too few known points were found in it.")
      .value("NO_AGREEMENT", LossReason::kNoAgreement, "Those found agree on no pose.")
      .value("DISBELIEVED", LossReason::kDisbelieved, "A pose was found, but is too weak.")
      .value("PLACE_UNKNOWN", LossReason::kPlaceUnknown, "It was not found in the map.");
  nb::class_<TrackedFrame>(m, "TrackedFrame", "What tracking found for one image. Immutable.")
      .def_ro("index", &TrackedFrame::index, "Of the image, from 0.")
      .def_ro("stamp", &TrackedFrame::stamp, "Seconds.")
      .def_ro("state", &TrackedFrame::state, "Whether it has a pose.")
      .def_prop_ro(
          "world_from_camera",
          [](const TrackedFrame& f) {
            return f.state == TrackingState::kTracking
                       ? std::optional(to_array(f.world_from_camera))
                       : std::nullopt;
          },
          kOwned,
          "(4, 4) float64, metres, as known when the frame was tracked; None without a pose.")
      .def_prop_ro(
          "component", [](const TrackedFrame& f) { return shown(nullptr, f.component); },
          "Of the map, in whose world the pose is; None for the frame that begins one.")
      .def_prop_ro(
          "reference", [](const TrackedFrame& f) { return shown(nullptr, f.reference); },
          "Id of the keyframe that the pose hangs on; None without one.")
      .def_prop_ro(
          "reference_from_camera",
          [](const TrackedFrame& f) { return to_array(f.reference_from_camera); }, kOwned,
          "(4, 4) float64, metres: the pose of today is that of the keyframe times this.")
      .def_ro("keypoints", &TrackedFrame::keypoints, "Found in the image.")
      .def_ro("inliers", &TrackedFrame::inliers, "Map points that agree with the pose.")
      .def_ro("rms_pixels", &TrackedFrame::rms_pixels, "Of the inliers, pixels.")
      .def_ro("is_keyframe", &TrackedFrame::is_keyframe, "Whether it was made a keyframe.")
      .def_ro("recovered", &TrackedFrame::recovered,
              "Found by descriptors alone, without a predicted pose.")
      .def("__repr__", [](const TrackedFrame& f) {
        static const char* const kStates[] = {"NOT_STARTED", "TRACKING", "LOST"};
        return fmt::format("TrackedFrame(index={}, stamp={:.6f}, {}, inliers={})", f.index, f.stamp,
                           kStates[static_cast<int>(f.state)], f.inliers);
      });
}

// The columns that keyframes and points share.
template <class Table>
void bind_columns(nb::class_<Table>& table) {
  table
      .def_prop_ro(
          "ids",
          [](const Table& t) {
            return column_array<std::uint32_t>(*t.rows, [](const auto& row) { return row.id; });
          },
          kOwned, "(N,) uint32.")
      .def_prop_ro(
          "components",
          [](const Table& t) {
            return column_array<std::uint32_t>(*t.rows,
                                               [](const auto& row) { return row.component; });
          },
          kOwned, "(N,) uint32: the component in whose world each is.")
      .def("__len__", [](const Table& t) { return t.rows->size(); });
}

void bind_tables(nb::module_& m) {
  nb::class_<KeyframeTable> keyframes(m, "KeyframePoses", "Keyframes, as arrays.");
  bind_columns(keyframes);
  keyframes
      .def_prop_ro(
          "stamps",
          [](const KeyframeTable& t) {
            return column_array<double>(*t.rows, [](const KeyframePose& k) { return k.stamp; });
          },
          kOwned, "(N,) float64, seconds.")
      .def_prop_ro(
          "world_from_camera",
          [](const KeyframeTable& t) {
            return poses_array(*t.rows, [](const KeyframePose& k) { return k.world_from_camera; });
          },
          kOwned, "(N, 4, 4) float64, metres.");
  nb::class_<PointTable> points(m, "PointPositions", "Points, as arrays.");
  bind_columns(points);
  points.def_prop_ro(
      "positions",
      [](const PointTable& t) {
        return rows_array<Array<double, -1, 3>>(*t.rows, 3, [](const PointPosition& p) {
          return std::array<double, 3>{p.position.x(), p.position.y(), p.position.z()};
        });
      },
      kOwned, "(N, 3) float64, metres, in the world of its component.");
}

// Waits in slices, so that Ctrl-C works.
nb::object next_event(Subscription& subscription, std::optional<double> timeout) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kSlice{50};
  const auto end = Clock::now() +
                   std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(std::clamp(timeout.value_or(0.0), 0.0, 1e9)));
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    const auto wait = timeout ? std::clamp(left, std::chrono::milliseconds(0), kSlice) : kSlice;
    MessagePtr message;
    {
      const Away away;
      message = subscription.next(wait);
    }
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (message) return to_event(message);
    if (subscription.has_ended() || (timeout && Clock::now() >= end)) return nb::none();
  }
}

void bind_subscription(nb::module_& m) {
  nb::class_<Subscription>(
      m, "Subscription",
      "A queue of events. Iterating waits for the next one, and ends when the "
      "System has finished or failed: do so in a thread of its own. Whoever "
      "reads too slowly loses the oldest events, and nobody waits. Any thread.")
      .def(
          "__iter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __iter__(self) -> Subscription"))
      .def(
          "__next__",
          [](Subscription& subscription) {
            const nb::object event = next_event(subscription, std::nullopt);
            if (event.is_none()) throw nb::stop_iteration();
            return event;
          },
          nb::sig("def __next__(self) -> Event"))
      .def(
          "next", &next_event, nb::arg("timeout") = nb::none(),
          nb::sig("def next(self, timeout: float | None = None) -> Event | None"),
          "The next event. Waits for it at most `timeout` seconds; 0: not at all. None if there is "
          "none, or has_ended.")
      .def_prop_ro("has_ended", &Subscription::has_ended, "Whether nothing can come any more.")
      .def_prop_ro("lost", &Subscription::lost,
                   "Events lost so far. Gaps in Event.number show where.");
}

// The kind of event that a class of Python stands for.
template <class... Events>
EventKinds kind_of(const nb::handle wanted, std::type_identity<std::variant<Events...>>) {
  EventKinds kind = EventKinds::none();
  const auto is = [&](const nb::handle type, EventKinds its) {
    if (!wanted.is(type)) return false;
    kind = its;
    return true;
  };
  if (!(is(nb::type<EventOf<Events>>(), EventKinds::of<Events>()) || ...)) {
    throw nb::type_error("kinds must be classes of events, e.g. dxslam.FrameTracked");
  }
  return kind;
}

}  // namespace

EventKinds kinds_of(const std::optional<nb::iterable>& classes) {
  if (!classes) return EventKinds::all();
  EventKinds kinds = EventKinds::none();
  for (const nb::handle wanted : *classes) {
    kinds = kinds | kind_of(wanted, std::type_identity<Event>());
  }
  return kinds;
}

nb::object to_event(const MessagePtr& message) {
  return std::visit(
      [&](const auto& event) {
        return nb::cast(EventOf<std::decay_t<decltype(event)>>{{message}});
      },
      message->event);
}

void bind_events(nb::module_& m) {
  bind_frame(m);
  bind_tables(m);
  bind_report(m);
  nb::class_<AnyEvent>(m, "Event", "Something that happened inside a System. Immutable.")
      .def_prop_ro(
          "number", [](const AnyEvent& event) { return event.message->number; },
          "Place in the stream: rises by one per event that somebody reads, from 1.")
      .def_prop_ro(
          "map_version", [](const AnyEvent& event) { return event.message->map_version; },
          "Of the map; rises when it has changed.")
      .def("__repr__", [](const nb::handle self) {
        std::string text = nb::cast<std::string>(self.type().attr("__name__"));
        text += fmt::format("(number={}", nb::cast<std::uint64_t>(self.attr("number")));
        for (const nb::handle name : self.type().attr("__match_args__")) {
          text += fmt::format(", {}={}", nb::cast<std::string>(name),
                              nb::cast<std::string>(nb::repr(nb::getattr(self, name))));
        }
        return text + ")";
      });
  bind_all_events(m);
  bind_subscription(m);
}

}  // namespace dxslam::python
