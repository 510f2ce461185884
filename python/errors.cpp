// The errors of Exemplar as Python exceptions: the same classes, the same messages.

#include "host/core/errors.h"

#include <pybind11/pybind11.h>

#include <exception>

#include "gpu/runtime/vulkan/errors.h"
#include "host/core/device_memory_error.h"
#include "python/arrays.h"
#include "python/bindings.h"

namespace exemplar::python {
namespace {

/// The Python class of a C++ error. It lives as long as the process: errors may be raised while Python ends.
template <typename CppError>
PyObject* python_class = nullptr;

/// Makes the Python class of an error and adds it to the module.
template <typename CppError>
void add_error(py::module_& module, const char* name, const py::object& bases, const char* doc) {
    const std::string full_name = std::string("exemplar.") + name;
    PyObject* const made = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
    if (!made) throw py::error_already_set();
    python_class<CppError> = made;
    module.add_object(name, made);
}

/// Adds an error below another one.
template <typename CppError, typename Base>
void add_error_below(py::module_& module, const char* name, const char* doc) {
    add_error<CppError>(module, name, py::reinterpret_borrow<py::object>(python_class<Base>), doc);
}

template <typename CppError>
void raise(const CppError& error) {
    PyErr_SetObject(python_class<CppError>, text(error.what()).ptr());
}

/// Catches derived errors before their bases, as catch clauses are tried in order.
void translate(std::exception_ptr error) {
    try {
        if (error) std::rethrow_exception(error);
    } catch (const NoDeviceError& e) {
        raise(e);
    } catch (const DeviceLostError& e) {
        raise(e);
    } catch (const DeviceLimitError& e) {
        raise(e);
    } catch (const DeviceMemoryError& e) {
        raise(e);
    } catch (const DeviceError& e) {
        raise(e);
    } catch (const MeshError& e) {
        raise(e);
    } catch (const DataError& e) {
        raise(e);
    } catch (const ModelError& e) {
        raise(e);
    } catch (const ShaderError& e) {
        raise(e);
    } catch (const UsageError& e) {
        raise(e);
    } catch (const Interrupted&) {
        PyErr_SetNone(PyExc_KeyboardInterrupt);
    } catch (const Error& e) {
        raise(e);
    }
}

}  // namespace

void add_errors(py::module_& module) {
    const auto exception = py::reinterpret_borrow<py::object>(PyExc_Exception);
    add_error<Error>(module, "Error", exception, "Base of all errors of Exemplar. The message is one line.");
    add_error_below<MeshError, Error>(module, "MeshError", "A mesh, or a file of one, that cannot be used.");
    add_error_below<DataError, Error>(module, "DataError",
                                      "A file of labels, a drawing, a list or another file that cannot be used.");
    add_error_below<ModelError, Error>(module, "ModelError",
                                       "A model file that is damaged, newer than this program, or of another kind.");
    add_error_below<DeviceError, Error>(module, "DeviceError", "A Vulkan device that cannot be used.");
    add_error_below<NoDeviceError, DeviceError>(module, "NoDeviceError",
                                                "There is no usable Vulkan device, or none of the name.");
    add_error_below<DeviceLostError, DeviceError>(module, "DeviceLostError", "The device stopped answering.");
    add_error_below<DeviceLimitError, DeviceError>(module, "DeviceLimitError",
                                                   "Something is larger than the device allows.");
    add_error_below<DeviceMemoryError, DeviceError>(module, "DeviceMemoryError",
                                                    "The memory of the device is used up.");
    add_error_below<ShaderError, Error>(module, "ShaderError", "A shader that does not fit the program: a defect.");
    const py::tuple usage_bases = py::make_tuple(py::reinterpret_borrow<py::object>(python_class<Error>),
                                                 py::reinterpret_borrow<py::object>(PyExc_ValueError));
    add_error<UsageError>(module, "UsageError", usage_bases,
                          "A wrong argument: of a shape, a range or a word that is not allowed. Also a ValueError.");
    py::register_exception_translator(&translate);
}

}  // namespace exemplar::python
