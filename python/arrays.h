#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar::python {

namespace py = pybind11;

// Returned arrays are views of the library's memory, without a copy. They keep that memory alive, and are read-only,
// as several objects may share it. Arrays passed in are checked and copied.

/// Returns a Python object that keeps `owner` alive: the base object of views.
py::capsule keeper(std::shared_ptr<const void> owner);
/// Makes an array read-only.
py::array read_only(py::array array);

/// Returns a read-only view of numbers that `owner` keeps alive. Strides are in bytes; none: row by row.
template <typename T>
py::array view(std::shared_ptr<const void> owner, const T* data, std::vector<py::ssize_t> shape,
               std::vector<py::ssize_t> strides = {}) {
    if (strides.empty()) strides = py::detail::c_strides(shape, sizeof(T));
    return read_only(py::array_t<T>(std::move(shape), std::move(strides), data, keeper(std::move(owner))));
}

/// Return views of lists of numbers (n), of vectors (n x 3) and of tuples (n x N).
template <typename T>
py::array list_view(std::shared_ptr<const void> owner, const std::vector<T>& list) {
    return view(std::move(owner), list.data(), {static_cast<py::ssize_t>(list.size())});
}
inline py::array list_view(std::shared_ptr<const void> owner, const std::vector<Vec3>& list) {
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    return view(std::move(owner), reinterpret_cast<const float*>(list.data()),
                {static_cast<py::ssize_t>(list.size()), 3});
}
template <typename T, std::size_t N>
py::array list_view(std::shared_ptr<const void> owner, const std::vector<std::array<T, N>>& list) {
    return view(std::move(owner), reinterpret_cast<const T*>(list.data()),
                {static_cast<py::ssize_t>(list.size()), static_cast<py::ssize_t>(N)});
}
/// Returns a view that owns its list.
template <typename List>
py::array own_view(List list) {
    const auto owner = std::make_shared<const List>(std::move(list));
    return list_view(owner, *owner);
}

/// Converts an argument to an array of numbers of the `kinds` ("iu": whole numbers, "fiu": any real ones) and of
/// that shape, in which -1 is any size. Throws TypeError for other values, UsageError for another shape, both with
/// `name`.
py::array numbers(const py::object& given, const std::string& name, const std::string& kinds,
                  const std::vector<py::ssize_t>& shape);

/// Converts an argument to points (n x 3).
std::vector<Vec3> points_of(const py::object& given, const std::string& name);
/// Converts an argument to triangles (m x 3) of existing vertices.
std::vector<Face> faces_of(const py::object& given, const std::string& name, std::size_t vertex_count);
/// Converts an argument to labels: for each of `count` faces a whole number from -1 to below `names`.
std::vector<std::int32_t> labels_of(const py::object& given, const std::string& name, std::size_t count,
                                    std::size_t names);
/// Converts an argument to a list of `count` numbers.
std::vector<float> floats_of(const py::object& given, const std::string& name, std::size_t count);
/// Converts an argument to a vector.
Vec3 vector_of(const py::object& given, const std::string& name);

/// Converts text for Python. Names of files may be in any encoding; bytes that are not UTF-8 become U+FFFD.
py::str text(const std::string& bytes);
py::list texts(const std::vector<std::string>& list);

/// Throws UsageError unless the value is from `least` to `most`.
void require_range(const std::string& name, std::int64_t value, std::int64_t least, std::int64_t most);
void require_range(const std::string& name, double value, double least, double most);

}  // namespace exemplar::python
