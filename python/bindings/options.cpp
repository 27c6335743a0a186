// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <nanobind/stl/string.h>

#include "bindings/bindings.h"
#include "io/formats/options_yaml.h"
#include "slam/system_options.h"

namespace dxslam::python {
namespace {

// Visitor that makes a dictionary of the described fields, groups as dictionaries in it.
class DictWriter {
 public:
  template <class Value>
  void operator()(OptionName name, const Value& value, const char*, const char*) {
    dict_[name.text] = nb::cast(value);
  }
  template <class Number>
  void operator()(OptionName name, const Number& value, Range, const char*, const char*) {
    dict_[name.text] = nb::cast(value);
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    DictWriter nested;
    Options::describe(options, nested);
    dict_[name] = nested.dict();
  }
  const nb::dict& dict() const { return dict_; }

 private:
  nb::dict dict_;
};

}  // namespace

void bind_options(nb::module_& m) {
  nb::class_<SystemOptions>(m, "OptionsBase", "The numbers behind dxslam.Options.")
      .def(nb::init<>())
      .def(nb::init<const SystemOptions&>())
      .def(
          "read_yaml",
          [](SystemOptions& options, const std::string& text, const std::string& where) {
            SystemOptions changed = options;
            read_options_yaml(text, where, changed);
            options = changed;
          },
          nb::arg("text"), nb::arg("where") = "options",
          "Changes what the text gives. Raises InputError, which names `where` and the line, for "
          "unknown keys, wrong types and values out of range, and changes nothing then.")
      .def(
          "to_yaml",
          [](const SystemOptions& options, bool experts) {
            OptionsYamlWriter writer(experts ? OptionsFor::kExperts : OptionsFor::kUsers);
            SystemOptions::describe(options, writer);
            return writer.text();
          },
          nb::arg("experts") = true,
          "A configuration file, with meaning, unit and range of each option as comments; the "
          "options for experts as well unless said.")
      .def(
          "to_dict",
          [](const SystemOptions& options) {
            DictWriter writer;
            SystemOptions::describe(options, writer);
            return writer.dict();
          },
          "All options by name; groups are dictionaries in it.");
}

}  // namespace dxslam::python
