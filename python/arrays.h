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

// Arrays that go out are views of the library's memory, without a copy: they keep what they show alive, and cannot be
// written, as several objects may share it. Arrays that come in are checked and copied.

/// A Python object that keeps `owner` alive: the base of views.
py::capsule keeper(std::shared_ptr<const void> owner);
/// Takes the right to write from an array.
py::array read_only(py::array array);

/// A read-only view of numbers that `owner` keeps; without strides (in bytes), row by row.
template <typename T>
py::array view(std::shared_ptr<const void> owner, const T* data, std::vector<py::ssize_t> shape,
               std::vector<py::ssize_t> strides = {}) {
    if (strides.empty()) strides = py::detail::c_strides(shape, sizeof(T));
    return read_only(py::array_t<T>(std::move(shape), std::move(strides), data, keeper(std::move(owner))));
}

/// Views of lists of numbers (n), of vectors (n x 3) and of tuples (n x N).
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
/// A view of a list that nothing else owns.
template <typename List>
py::array own_view(List list) {
    const auto owner = std::make_shared<const List>(std::move(list));
    return list_view(owner, *owner);
}

/// What was given as an array of numbers of some `kinds` ("iu": whole numbers, "fiu": any real ones) and dimensions, of
/// which -1 is any size. Throws TypeError for other values, UsageError for another shape, both with `name`.
py::array numbers(const py::object& given, const std::string& name, const std::string& kinds,
                  const std::vector<py::ssize_t>& shape);

/// Points (n x 3).
std::vector<Vec3> points_of(const py::object& given, const std::string& name);
/// Triangles (m x 3), whose vertices must be there.
std::vector<Face> faces_of(const py::object& given, const std::string& name, std::size_t vertex_count);
/// One whole number from -1 to below `names` for each of `count` faces.
std::vector<std::int32_t> labels_of(const py::object& given, const std::string& name, std::size_t count,
                                    std::size_t names);
/// A list of numbers.
std::vector<float> floats_of(const py::object& given, const std::string& name, std::size_t count);
/// A single vector.
Vec3 vector_of(const py::object& given, const std::string& name);

/// Text for Python. Names of files may be in any encoding; what is not UTF-8 becomes U+FFFD.
py::str text(const std::string& bytes);
py::list texts(const std::vector<std::string>& list);

/// Throws UsageError unless the value is from `least` to `most`.
void require_range(const std::string& name, std::int64_t value, std::int64_t least, std::int64_t most);
void require_range(const std::string& name, double value, double least, double most);

}  // namespace exemplar::python
