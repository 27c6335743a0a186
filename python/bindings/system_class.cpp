// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/system.h"
#include "bindings/trajectory.h"

namespace dxslam::python {
namespace {

// So that a System and what its callback holds on to can be collected together.
int visit_callback(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  if (FrameCallback* callback = nb::inst_ptr<PySystem>(self)->callback()) {
    Py_VISIT(callback->function().ptr());
  }
  return 0;
}
int clear_callback(PyObject* self) {
  if (FrameCallback* callback = nb::inst_ptr<PySystem>(self)->callback()) callback->clear();
  return 0;
}
PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(visit_callback)},
                       {Py_tp_clear, reinterpret_cast<void*>(clear_callback)},
                       {0, nullptr}};

void bind_input(nb::class_<PySystem>& system) {
  constexpr const char* kArrays =
      "`stamp`: seconds, rising. `color`: (H, W, 3) uint8 BGR, or (H, W) uint8. `depth`: (H, W), "
      "metres as float32 or raw (Camera.depth_factor) as uint16, registered to colour; 0 where "
      "there is no reading. Contiguous arrays are shared, not copied (but uint16, which is "
      "converted): leave them as they are until this returns.";
  static const std::string process_doc =
      std::string(
          "Takes the next image. Extracts its features while the one before is tracked, and "
          "waits while tracking is Options.queued_frames behind.\n\n") +
      kArrays + "\nRaises InputError for an image that does not fit; the next one may follow.";
  static const std::string try_doc =
      std::string(
          "The same for live input: returns False, dropping the image, if tracking is that "
          "far behind; mapping never holds up tracking.\n\n") +
      kArrays;
  system
      .def(
          "process",
          [](PySystem& self, double stamp, const ImageArgument& color,
             const std::optional<ImageArgument>& depth) {
            self.process_arrays(stamp, color, depth, false);
          },
          nb::arg("stamp"), nb::arg("color"), nb::arg("depth") = nb::none(), process_doc.c_str())
      .def(
          "process", [](PySystem& self, const RgbdImage& image) { self.process(image, false); },
          nb::arg("image"), "The same of an image of a source.")
      .def(
          "try_process",
          [](PySystem& self, double stamp, const ImageArgument& color,
             const std::optional<ImageArgument>& depth) {
            return self.process_arrays(stamp, color, depth, true);
          },
          nb::arg("stamp"), nb::arg("color"), nb::arg("depth") = nb::none(), try_doc.c_str())
      .def(
          "try_process",
          [](PySystem& self, const RgbdImage& image) { return self.process(image, true); },
          nb::arg("image"), "The same of an image of a source.")
      .def("begin_sequence", &PySystem::begin_sequence,
           "The next image is of another recording: it may be anywhere in the map.")
      .def("set_mapping", &PySystem::set_mapping, nb::arg("on"),
           "Switches between mapping and localization in the map so far, from the next image on. "
           "Any thread.")
      .def("load_map", &PySystem::load_map, nb::arg("map"),
           "Goes on with a map: the first images look for their place in it. Before the first "
           "image only. The map is copied but for its frames. Raises InputError if it was made "
           "with another extractor.")
      .def(
          "finish", [](PySystem& self) { self.finish(true); },
          "Waits until all is done, and adjusts the whole map once more (Options.final_bundle). "
          "Results can be read then. Ctrl-C gives the adjustment up and raises KeyboardInterrupt; "
          "results can be read all the same. Raises what went wrong in tracking or mapping.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> System"), "Itself.")
      .def(
          "__exit__",
          [](PySystem& self, const nb::object& type, const nb::object&, const nb::object&) {
            if (type.is_none()) return self.finish(true);
            try {
              self.finish(false);  // something else is raised already
            } catch (const std::exception&) {
            }
          },
          nb::arg("type").none(), nb::arg("value").none(), nb::arg("traceback").none(),
          "finish(); after an exception without adjusting the map.");
}

void bind_events_of(nb::class_<PySystem>& system) {
  system
      .def("subscribe", &PySystem::subscribe, nb::arg("capacity") = 1024,
           nb::arg("kinds") = nb::none(),
           nb::sig("def subscribe(self, capacity: int = 1024, kinds: "
                   "collections.abc.Iterable[type[Event]] | None = None) -> Subscription"),
           "Events from now on, or those of some classes, of which at most `capacity` wait to be "
           "read. Any thread.")
      .def("all_poses", &PySystem::all_poses,
           "Poses of all images tracked so far, as the map has them now. None once a change of the "
           "map has failed halfway. Waits while the map is worked on. Any thread.")
      .def("whole_map", &PySystem::whole_map, nb::sig("def whole_map(self) -> MapChanged | None"),
           "All of the map as it is now, as added, with its map_version; events of later versions "
           "change it. None once a change has failed halfway. Waits while the map is worked on. "
           "Any thread.")
      .def_prop_ro(
          "has_failed", [](const PySystem& self) { return self.system().has_failed(); },
          "Whether something went wrong in tracking or mapping: no image is taken any more. Any "
          "thread.")
      .def_prop_ro("notes", &PySystem::notes,
                   "Sentences about the features: what works less well than it could.")
      .def_prop_ro(
          "camera", [](const PySystem& self) { return self.camera(); }, "The camera.")
      .def_prop_ro(
          "extractor", [](const PySystem& self) { return self.extractor(); }, "The extractor.");
}

void bind_summaries(nb::module_& m) {
  nb::class_<AllPoses>(m, "AllPoses", "Where the images so far were, by the map at one moment.")
      .def_ro("map_version", &AllPoses::map_version, "Changes up to this one are in it.")
      .def_prop_ro(
          "indices",
          [](const AllPoses& all) {
            return column_array<std::int64_t>(all.frames,
                                              [](const FramePose& f) { return f.index; });
          },
          kOwned, "(N,) int64: of the images.")
      .def_prop_ro(
          "stamps",
          [](const AllPoses& all) {
            return column_array<double>(all.frames, [](const FramePose& f) { return f.stamp; });
          },
          kOwned, "(N,) float64, seconds.")
      .def_prop_ro(
          "components",
          [](const AllPoses& all) {
            return column_array<std::uint32_t>(all.frames,
                                               [](const FramePose& f) { return f.component; });
          },
          kOwned, "(N,) uint32: in whose world each pose is.")
      .def_prop_ro(
          "world_from_camera",
          [](const AllPoses& all) {
            return poses_array(all.frames, [](const FramePose& f) { return f.world_from_camera; });
          },
          kOwned, "(N, 4, 4) float64, metres.")
      .def("__len__", [](const AllPoses& all) { return all.frames.size(); });
  nb::class_<ComponentSummary>(m, "ComponentSummary", "One map of several, each of its own world.")
      .def_ro("component", &ComponentSummary::component, "Its number.")
      .def_ro("keyframes", &ComponentSummary::keyframes, "How many it has.")
      .def_ro("points", &ComponentSummary::points, "How many it has.")
      .def_ro("frames", &ComponentSummary::frames, "Images tracked in it.");
  nb::class_<StageSummary>(m, "StageSummary", "Times of one stage.")
      .def_ro("count", &StageSummary::count, "How many times.")
      .def_ro("median_ms", &StageSummary::median_ms, "Milliseconds, right to 1 %.")
      .def_ro("p95_ms", &StageSummary::p95_ms, "95th percentile, milliseconds, right to 1 %.")
      .def_ro("max_ms", &StageSummary::max_ms, "Milliseconds.")
      .def_ro("total_ms", &StageSummary::total_ms, "Sum, milliseconds.");
  nb::class_<FrameLog>(m, "Frames",
                       "Every image that was given, in order: a sequence of TrackedFrame, most of "
                       "it on the disk.")
      .def("__len__", &FrameLog::size)
      .def("__getitem__", [](const FrameLog& frames, std::int64_t i) {
        const auto size = static_cast<std::int64_t>(frames.size());
        if (i < -size || i >= size) throw nb::index_error("there is no such frame");
        return frames[static_cast<std::size_t>(i < 0 ? i + size : i)];
      });
}

void bind_results(nb::class_<PySystem>& system) {
  using Component = std::optional<std::uint32_t>;
  system
      .def(
          "trajectory",
          [](const PySystem& self, Component c) { return self.finished().trajectory(c); },
          nb::arg("component") = nb::none(),
          "Poses of the images tracked in one component, as the final map has them; of the one "
          "with "
          "most images unless said. After finish().")
      .def(
          "keyframe_trajectory",
          [](const PySystem& self, Component c) { return self.finished().keyframe_trajectory(c); },
          nb::arg("component") = nb::none(), "Poses of the keyframes, likewise.")
      .def(
          "frames",
          [](const PySystem& self) -> const FrameLog& { return self.finished().frames(); },
          nb::rv_policy::reference_internal,
          "What tracking found for each image, as known then. After finish().")
      .def(
          "components", [](const PySystem& self) { return self.finished().components(); },
          "All maps there are, the one with most images first. After finish().")
      .def("map", &PySystem::map,
           "The map, which is shared, not copied. After finish(). Raises ContractError where a "
           "change of it has failed halfway.")
      .def(
          "times", [](const PySystem& self) { return self.times(); },
          "Milliseconds of each stage so far, by name: extract, track, frame, and so on.")
      .def(
          "callback_failures",
          [](const PySystem& self) {
            const CallbackFailures failures = self.finished().callback_failures();
            return std::pair(failures.count, failures.first);
          },
          "How often on_frame has raised something, and the text of the first. It ends nothing. "
          "After finish().");
}

}  // namespace

void bind_system(nb::module_& m) {
  bind_summaries(m);
  nb::class_<PySystem> system(
      m, "System", nb::type_slots(slots),
      "Visual SLAM with a colour and depth camera: images in, poses and a map out.\n\n"
      "Features are extracted in the thread that calls process(); tracking and mapping have "
      "threads "
      "of their own, and the GIL is released. Images must come from one thread at a time. With "
      "Options.deterministic all happens in the caller's thread, and equal input gives equal "
      "output "
      "to the bit.\n\n"
      "    with dxslam.System(camera) as slam:\n"
      "        for stamp, color, depth in my_camera():\n"
      "            slam.process(stamp, color, depth)\n"
      "    slam.trajectory().write('trajectory.txt')\n");
  system.def(
      nb::init<const Camera&, const std::optional<SystemOptions>&,
               const std::optional<SharedExtractor>&, nb::object>(),
      nb::arg("camera"), nb::arg("options") = nb::none(), nb::arg("extractor") = nb::none(),
      nb::arg("on_frame") = nb::none(),
      nb::sig("def __init__(self, camera: Camera, options: OptionsBase | None = None, "
              "extractor: Extractor | None = None, on_frame: "
              "collections.abc.Callable[[TrackedFrame], object] | None = None) -> None"),
      "`extractor`: one that is loaded already; else Options.features says which. "
      "`on_frame` is called for each image by the tracking thread, with the GIL: what it "
      "takes tracking waits for (events do not hold it up). What it raises ends nothing, see "
      "callback_failures(). Raises InputError for options that cannot be used.");
  bind_input(system);
  bind_events_of(system);
  bind_results(system);
}

}  // namespace dxslam::python
