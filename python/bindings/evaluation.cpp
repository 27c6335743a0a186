// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/trajectory.h"
#include "core/error.h"
#include "evaluation/ate.h"
#include "evaluation/rpe.h"

namespace dxslam::python {
namespace {

Alignment alignment_of(const std::string& name) {
  if (name == "none") return Alignment::kNone;
  if (name == "se3") return Alignment::kSe3;
  if (name == "sim3") return Alignment::kSim3;
  throw InputError(fmt::format("alignment is '{}', expected none, se3 or sim3", name));
}

RpeOptions::Unit unit_of(const std::string& name) {
  if (name == "frames") return RpeOptions::Unit::kFrames;
  if (name == "seconds") return RpeOptions::Unit::kSeconds;
  throw InputError(fmt::format("unit is '{}', expected frames or seconds", name));
}

void bind_statistics(nb::module_& m) {
  nb::class_<ErrorStatistics>(m, "ErrorStatistics", "Summary of errors, in their unit.")
      .def_ro("rmse", &ErrorStatistics::rmse, "Root of the mean square.")
      .def_ro("mean", &ErrorStatistics::mean, "Mean.")
      .def_ro("median", &ErrorStatistics::median, "Median.")
      .def_ro("std", &ErrorStatistics::std, "Standard deviation of the population.")
      .def_ro("min", &ErrorStatistics::min, "Smallest.")
      .def_ro("max", &ErrorStatistics::max, "Largest.")
      .def_ro("count", &ErrorStatistics::count, "How many errors there are.")
      .def("__repr__", [](const ErrorStatistics& s) {
        return fmt::format(
            "ErrorStatistics(rmse={:.6g}, mean={:.6g}, median={:.6g}, max={:.6g}, "
            "count={})",
            s.rmse, s.mean, s.median, s.max, s.count);
      });
}

void bind_ate(nb::module_& m) {
  nb::class_<AteReport>(m, "AteReport", "Absolute trajectory error.")
      .def_ro("position", &AteReport::position, "Summary of `errors`, metres.")
      .def_prop_ro(
          "errors",
          [](const AteReport& r) {
            return column_array<double>(r.errors, [](double error) { return error; });
          },
          kOwned, "(N,) float64, metres: one per pair of poses.")
      .def_prop_ro(
          "stamps",
          [](const AteReport& r) {
            return column_array<double>(r.pairs, [](const PosePair& p) { return p.truth.stamp; });
          },
          kOwned, "(N,) float64, seconds: of the true poses compared.")
      .def_prop_ro(
          "truth_from_estimate",
          [](const AteReport& r) { return to_array(RowMajor4(r.truth_from_estimate.matrix())); },
          kOwned, "(4, 4) float64: the alignment found, [scale R, t; 0, 1].")
      .def_prop_ro(
          "scale", [](const AteReport& r) { return r.truth_from_estimate.scale(); },
          "Of the alignment; 1 unless sim3.");
  m.def(
      "evaluate_ate",
      [](const Trajectory& truth, const Trajectory& estimate, const std::string& alignment,
         double max_difference) {
        return evaluate_ate(truth, estimate, {alignment_of(alignment), max_difference});
      },
      nb::arg("truth"), nb::arg("estimate"), nb::arg("alignment") = "se3",
      nb::arg("max_difference") = AteOptions().max_difference,
      "Absolute trajectory error (Sturm et al. 2012): distances of positions of the same time, "
      "at most `max_difference` seconds apart, after the alignment: none, se3 or sim3. Raises "
      "InputError if no stamps match or the alignment is undefined.");
}

void bind_rpe(nb::module_& m) {
  nb::class_<RpeReport>(m, "RpeReport", "Relative pose error.")
      .def_ro("translation", &RpeReport::translation, "Metres.")
      .def_ro("rotation", &RpeReport::rotation, "Degrees.");
  m.def(
      "evaluate_rpe",
      [](const Trajectory& truth, const Trajectory& estimate, double delta, const std::string& unit,
         bool all_pairs, const std::string& alignment, double max_difference) {
        RpeOptions options;
        options.delta = delta;
        options.unit = unit_of(unit);
        options.all_pairs = all_pairs;
        options.alignment = alignment_of(alignment);
        options.max_difference = max_difference;
        return evaluate_rpe(truth, estimate, options);
      },
      nb::arg("truth"), nb::arg("estimate"), nb::arg("delta") = 1.0, nb::arg("unit") = "frames",
      nb::arg("all_pairs") = true, nb::arg("alignment") = "none",
      nb::arg("max_difference") = RpeOptions().max_difference,
      "Relative pose error (Sturm et al. 2012): how far relative motions over `delta` frames or "
      "seconds differ. `all_pairs`: every pose starts a pair; else each pair starts where the one "
      "before ended. Raises InputError if no stamps match or no two poses are delta apart.");
}

}  // namespace

void bind_evaluation(nb::module_& m) {
  bind_statistics(m);
  bind_ate(m);
  bind_rpe(m);
}

}  // namespace dxslam::python
