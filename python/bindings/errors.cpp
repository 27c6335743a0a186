// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <nanobind/stl/string.h>

#include <string>

#include "bindings/bindings.h"
#include "core/error.h"

namespace dxslam::python {
namespace {

PyObject* input_error = nullptr;
PyObject* contract_error = nullptr;

PyObject* add_error(nb::module_& m, const char* name, nb::handle bases, const char* doc) {
  const std::string full = nb::cast<std::string>(m.attr("__name__")) + "." + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw nb::python_error();
  m.attr(name) = nb::steal(type);
  return type;
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    PyErr_SetString(input_error, error.what());
  } catch (const ContractError& error) {
    PyErr_SetString(contract_error, error.what());
  }
}

}  // namespace

void bind_errors(nb::module_& m) {
  PyObject* base = add_error(m, "Error", nb::handle(PyExc_Exception), "All that dxslam raises.");
  const nb::tuple input = nb::make_tuple(nb::handle(base), nb::handle(PyExc_ValueError));
  input_error = add_error(
      m, "InputError", input,
      "Unusable input: a file, an image, an option. One sentence says what was found, where, and "
      "what was expected. Is a ValueError as well.");
  const nb::tuple contract = nb::make_tuple(nb::handle(base), nb::handle(PyExc_RuntimeError));
  contract_error = add_error(m, "ContractError", contract,
                             "Wrong use, a bug of the caller's. Is a RuntimeError as well.");
  nb::register_exception_translator(translate);
}

}  // namespace dxslam::python
