// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include <eigencrust/error.h>

#include "bindings.h"

namespace eigencrust::python {

void bind_errors() {
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      const py::object value =
          py::module_::import("eigencrust._errors")
              .attr("make_error")(static_cast<int>(error.kind()), error.place(), error.cause(), error.remedy());
      PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(value.ptr())), value.ptr());
    } catch (const std::length_error&) { // a container larger than any memory
      PyErr_NoMemory();
    }
  });
}

} // namespace eigencrust::python
