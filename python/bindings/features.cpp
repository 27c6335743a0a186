// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>
#include <optional>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/extractor.h"
#include "bindings/images.h"
#include "bindings/interruptible.h"
#include "core/error.h"
#include "features/extractor_factory.h"
#include "matching/descriptor_matching.h"
#include "slam/system_options.h"
#include "slam/system_setup.h"

namespace dxslam::python {
namespace {

using Matches = std::pair<Array<std::int32_t, -1, 2>, Array<float, -1>>;

Matches match(const ImageArgument& a, const ImageArgument& b, std::optional<float> max_distance,
              float ratio) {
  const cv::Mat first = descriptor_matrix(a);
  const cv::Mat second = descriptor_matrix(b);
  if (first.type() != second.type() || first.cols != second.cols) {
    throw InputError("the descriptors are of two kinds, expected the same type and length");
  }
  if (!(ratio > 0.0F)) throw InputError(fmt::format("ratio is {}, expected more than 0", ratio));
  std::vector<Match> matches;
  {
    const nb::gil_scoped_release release;
    matches = match_mutual(first, second, max_distance.value_or(HUGE_VALF), ratio);
  }
  return {rows_array<Array<std::int32_t, -1, 2>>(
              matches, 2, [](const Match& m) { return std::array<std::int32_t, 2>{m.a, m.b}; }),
          column_array<float>(matches, [](const Match& m) { return m.distance; })};
}

void bind_result(nb::module_& m) {
  nb::class_<Features>(m, "Features", "What an extractor says of one image.")
      .def_prop_ro(
          "keypoints",
          [](const Features& features) {
            return rows_array<Array<float, -1, 4>>(features.keypoints, 4, [](const Keypoint& k) {
              return std::array<float, 4>{k.x, k.y, k.score, k.sigma};
            });
          },
          kOwned,
          "(N, 4) float32, by falling score: x and y in raw pixels (pixel centres are at whole "
          "numbers), score (comparable within one extractor), standard deviation in pixels.")
      .def_prop_ro(
          "descriptors",
          [](const Features& features) { return descriptor_array(features.descriptors); }, kOwned,
          "(N, D) float32 with rows of unit length, or (N, D) uint8, D bytes of bits each. "
          "Read-only.")
      .def_prop_ro(
          "global_descriptor",
          [](const Features& features) {
            std::optional<Array<float, -1>> global;
            if (!features.global.empty()) {
              global = to_array<Array<float, -1>>(features.global, {features.global.size()});
            }
            return global;
          },
          kOwned,
          "(G,) float32 of unit length, of the whole image; None where the extractor has none or "
          "was not asked.")
      .def("__len__", [](const Features& features) { return features.size(); });
}

void bind_traits(nb::class_<SharedExtractor>& extractor) {
  extractor.def_prop_ro("name", &SharedExtractor::name, "Its name, as maps have it.")
      .def_prop_ro(
          "dimension", [](const SharedExtractor& e) { return e.traits().dimension; },
          "D: floats of a descriptor, or bytes where is_binary.")
      .def_prop_ro(
          "is_binary", [](const SharedExtractor& e) { return e.traits().binary; },
          "Whether descriptors are bits, compared by Hamming distance; else floats, by L2 "
          "distance.")
      .def_prop_ro(
          "max_distance", [](const SharedExtractor& e) { return e.traits().max_distance; },
          "Farthest distance at which two descriptors may be of the same point.")
      .def_prop_ro(
          "global_dimension", [](const SharedExtractor& e) { return e.traits().global_dimension; },
          "G: floats of the global descriptor; 0 where there is none.")
      .def_prop_ro("precision", &SharedExtractor::precision, "What runs it: int8, f32, cpu.")
      .def_prop_ro("notes", &SharedExtractor::notes,
                   "Sentences about what works less well than it could.");
}

}  // namespace

SharedExtractor load_extractor(const std::string& name, const ExtractorOptions& options) {
  return SharedExtractor(interruptible([=] { return make_extractor(name, options); }));
}

void bind_features(nb::module_& m) {
  bind_result(m);
  nb::class_<SharedExtractor> extractor(
      m, "Extractor",
      "Image in, keypoints and descriptors out. One may serve a System, a Map and you at once, "
      "each in turn.");
  extractor
      .def(
          "__init__",
          [](SharedExtractor* self, const std::string& features,
             const std::optional<SystemOptions>& options) {
            SystemOptions settled = options.value_or(SystemOptions());
            settled.features = features;
            settle_options(settled);
            new (self) SharedExtractor(load_extractor(settled.features, settled.extractor));
          },
          nb::arg("features") = "auto", nb::arg("options") = nb::none(),
          "Loads `hfnet` (the network that is shipped), `orb`, or the manifest file of a network; "
          "auto: the best there is. Of the options, `extractor` and `deterministic` count. Raises "
          "InputError for unknown names and unusable models.")
      .def(
          "extract",
          [](SharedExtractor& e, const ImageArgument& image, bool with_global) {
            Features features;
            {
              cv::Mat color = color_image(image);
              const nb::gil_scoped_release release;
              features = e.extract(color, with_global);
              features.encoder.release();
              color.release();
            }
            release_arrays();
            return features;
          },
          nb::arg("image"), nb::arg("with_global") = true,
          "Features of an image, (H, W, 3) uint8 BGR or (H, W) uint8, which is not copied. "
          "`with_global`: the global descriptor as well. Raises InputError for other arrays.")
      .def("__repr__", [](const SharedExtractor& e) {
        return fmt::format("Extractor({}, {}, {})", e.name(), e.traits().dimension, e.precision());
      });
  bind_traits(extractor);
  m.def("match", &match, nb::arg("a"), nb::arg("b"), nb::arg("max_distance") = nb::none(),
        nb::arg("ratio") = 1.0F,
        "Mutual nearest neighbours among descriptors (N, D) and (M, D), float32 or uint8. Returns "
        "pairs (K, 2) int32, rows of a and b by rising a, and distances (K,) float32: L2, or "
        "differing bits. `max_distance`: see Extractor.max_distance; None: any. `ratio`: most of "
        "the distance to the second nearest; 1: any.");
  m.def("available_extractors", &available_extractors,
        "Names of the extractors whose models are there.");
}

}  // namespace dxslam::python
