// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "bindings/bindings.h"
#include "bindings/interruptible.h"
#include "bindings/trajectory.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::python {
namespace {

// A recording that any thread may read.
class Source {
 public:
  explicit Source(std::unique_ptr<RgbdSequence> sequence) : sequence_(std::move(sequence)) {}

  const RgbdSequence& sequence() const { return *sequence_; }
  /// Nothing for a broken image. Without the GIL.
  std::optional<RgbdImage> read(std::size_t index) {
    const std::lock_guard lock(mutex_);
    return sequence_->read(index);
  }
  std::vector<std::pair<std::size_t, std::string>> skipped() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<std::size_t, std::string>> skipped;
    for (const SkippedFrame& frame : sequence_->skipped()) {
      skipped.emplace_back(frame.index, frame.reason);
    }
    return skipped;
  }

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<RgbdSequence> sequence_;
};

struct SourceIterator {
  std::shared_ptr<Source> source;
  std::size_t index = 0;

  RgbdImage next() {
    const nb::gil_scoped_release release;
    while (index < source->sequence().size()) {
      if (std::optional<RgbdImage> image = source->read(index++)) return *image;
    }
    throw nb::stop_iteration();
  }
};

std::shared_ptr<Source> open(const std::filesystem::path& path, const std::string& format,
                             const std::optional<std::filesystem::path>& calibration,
                             const std::optional<std::filesystem::path>& association,
                             const std::optional<std::string>& color_topic,
                             const std::optional<std::string>& depth_topic) {
  SequenceOptions options;
  options.format = format;
  options.calibration = calibration.value_or("").string();
  options.association = association.value_or("").string();
  options.color_topic = color_topic.value_or("");
  options.depth_topic = depth_topic.value_or("");
  return interruptible([path = path.string(), options] {
    return std::make_shared<Source>(open_sequence(path, options));
  });
}

void bind_facts(nb::class_<Source>& source) {
  source
      .def_prop_ro(
          "name", [](const Source& s) { return s.sequence().name(); }, "Of the recording.")
      .def_prop_ro(
          "camera", [](const Source& s) { return s.sequence().camera(); }, "The colour camera.")
      .def_prop_ro(
          "calibration_source",
          [](const Source& s) { return s.sequence().facts().calibration_source; },
          "The file, topic or preset that the camera is from.")
      .def_prop_ro(
          "has_depth", [](const Source& s) { return s.sequence().facts().has_depth; },
          "Whether some image has depth.")
      .def_prop_ro(
          "notes", [](const Source& s) { return s.sequence().facts().notes; },
          "What was guessed, chosen or left out, one sentence each: for you to judge.")
      .def_prop_ro("skipped", &Source::skipped,
                   "Images that could not be used so far: index, and one sentence why.")
      .def_prop_ro(
          "stamps",
          [](const Source& s) {
            std::vector<double> stamps(s.sequence().size());
            for (std::size_t i = 0; i < stamps.size(); ++i) stamps[i] = s.sequence().stamp(i);
            return stamps;
          },
          "Of all images, seconds.")
      .def_prop_ro(
          "ground_truth", [](const Source& s) { return s.sequence().ground_truth(); },
          "The true poses of the camera; empty where they are not known.");
}

}  // namespace

void bind_source(nb::module_& m) {
  nb::class_<SourceIterator>(m, "SourceIterator", "Reads a source, one image after the other.")
      .def(
          "__iter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __iter__(self) -> SourceIterator"))
      .def("__next__", &SourceIterator::next);
  nb::class_<Source> source(m, "Source",
                            "Images with depth, in time order. Iterating reads one after the other "
                            "and leaves out broken ones, see `skipped`.");
  source
      .def(
          "__iter__", [](std::shared_ptr<Source> s) { return SourceIterator{std::move(s)}; },
          "From the first image on.")
      .def("__len__", [](const Source& s) { return s.sequence().size(); })
      .def("__repr__", [](const Source& s) {
        return fmt::format("Source({}, {} images)", s.sequence().name(), s.sequence().size());
      });
  source.def(
      "read",
      [](Source& s, std::size_t index) {
        const nb::gil_scoped_release release;
        return s.read(index);
      },
      nb::arg("index"), "Image `index`, less than len(). None for a broken one, see `skipped`.");
  bind_facts(source);
  m.def(
      "open_source", &open, nb::arg("path"), nb::arg("format") = "auto", nb::kw_only(),
      nb::arg("calibration") = nb::none(), nb::arg("association") = nb::none(),
      nb::arg("color_topic") = nb::none(), nb::arg("depth_topic") = nb::none(),
      "Opens a recording, a folder or a bag: all that `dxslam run` reads. `calibration`: a preset "
      "or camera file in place of the recording's own. `association`: a file that pairs colour "
      "with depth images. The topics: of a bag, where the likeliest ones are wrong. Raises "
      "InputError for what makes the recording unusable as a whole.");
  m.def("source_formats", &sequence_formats, "Names for the format of a recording.");
}

}  // namespace dxslam::python
