#include "python/arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "host/core/errors.h"

namespace exemplar::python {
namespace {

std::string shape_text(const std::vector<py::ssize_t>& shape) {
    std::vector<std::string> sizes;
    sizes.reserve(shape.size());
    for (const py::ssize_t size : shape) sizes.push_back(size < 0 ? "N" : std::to_string(size));
    return fmt::format("({})", shape.size() == 1 ? sizes[0] + "," : fmt::format("{}", fmt::join(sizes, ", ")));
}

bool fits(const py::array& array, const std::vector<py::ssize_t>& shape) {
    if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
    for (std::size_t i = 0; i < shape.size(); ++i)
        if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
    return true;
}

/// Converts the numbers of an array to another type, row by row.
template <typename T>
py::array_t<T, py::array::c_style | py::array::forcecast> converted(const py::array& array, const std::string& name) {
    auto result = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!result) throw py::type_error(name + ": these numbers cannot be converted");
    return result;
}

/// Converts to whole numbers (rows x width) from `least` to below `end`; `what` completes the message for others.
template <typename Out>
std::vector<Out> whole_numbers(const py::array& array, const std::string& name, std::int64_t least, std::int64_t end,
                               const std::string& what) {
    const auto given = converted<std::int64_t>(array, name);
    const std::int64_t* const values = given.data();
    const auto width = given.ndim() > 1 ? given.shape(1) : 1;
    std::vector<Out> result(static_cast<std::size_t>(given.size()));
    for (py::ssize_t i = 0; i < given.size(); ++i) {
        if (values[i] < least || values[i] >= end)
            throw UsageError(fmt::format("{}: row {} has {}, {}", name, i / width, values[i], what));
        result[static_cast<std::size_t>(i)] = static_cast<Out>(values[i]);
    }
    return result;
}

}  // namespace

py::capsule keeper(std::shared_ptr<const void> owner) {
    using Owner = std::shared_ptr<const void>;
    return {new Owner(std::move(owner)), [](void* pointer) { delete static_cast<Owner*>(pointer); }};
}

py::array read_only(py::array array) {
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array numbers(const py::object& given, const std::string& name, const std::string& kinds,
                  const std::vector<py::ssize_t>& shape) {
    auto array = py::array::ensure(given);
    const std::string wanted = kinds == "iu" ? "whole numbers" : "numbers";
    if (!array) throw py::type_error(fmt::format("{}: an array of {} is needed", name, wanted));
    // An empty list is an array of floating-point numbers to NumPy.
    const bool any_kind = array.size() == 0;
    const std::string accepted = any_kind ? "fiu" : kinds;
    if (accepted.find(array.dtype().kind()) == std::string::npos)
        throw py::type_error(
            fmt::format("{}: an array of {} is needed, not of {}", name, wanted, std::string(py::str(array.dtype()))));
    if (any_kind && array.ndim() == 1) return array;
    if (!fits(array, shape)) {
        const std::vector<py::ssize_t> is(array.shape(), array.shape() + array.ndim());
        throw UsageError(fmt::format("{}: an array of shape {} is needed, not {}", name, shape_text(shape),
                                     is.empty() ? "a single number" : shape_text(is)));
    }
    return array;
}

std::vector<Vec3> points_of(const py::object& given, const std::string& name) {
    const auto values = converted<float>(numbers(given, name, "fiu", {-1, 3}), name);
    std::vector<Vec3> points(static_cast<std::size_t>(values.size() / 3));
    std::copy_n(values.data(), 3 * points.size(), reinterpret_cast<float*>(points.data()));
    return points;
}

std::vector<Face> faces_of(const py::object& given, const std::string& name, std::size_t vertex_count) {
    if (vertex_count > std::numeric_limits<std::uint32_t>::max())
        throw UsageError("vertices: there are more than a face can number; give fewer than 2^32");
    const auto corners = whole_numbers<std::uint32_t>(
        numbers(given, name, "iu", {-1, 3}), name, 0, static_cast<std::int64_t>(vertex_count),
        fmt::format("but vertices are numbered from 0 to {}", static_cast<std::int64_t>(vertex_count) - 1));
    std::vector<Face> faces(corners.size() / 3);
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = {corners[3 * f], corners[3 * f + 1], corners[3 * f + 2]};
    return faces;
}

std::vector<std::int32_t> labels_of(const py::object& given, const std::string& name, std::size_t count,
                                    std::size_t names) {
    const py::array array = numbers(given, name, "iu", {static_cast<py::ssize_t>(count)});
    if (static_cast<std::size_t>(array.size()) != count)
        throw UsageError(fmt::format("{}: there are {} for {} faces; give one for each", name, array.size(), count));
    return whole_numbers<std::int32_t>(
        array, name, -1, static_cast<std::int64_t>(names),
        fmt::format("but labels are numbered from 0 to {}, or -1 for none", static_cast<std::int64_t>(names) - 1));
}

std::vector<float> floats_of(const py::object& given, const std::string& name, std::size_t count) {
    const auto values = converted<float>(numbers(given, name, "fiu", {static_cast<py::ssize_t>(count)}), name);
    if (static_cast<std::size_t>(values.size()) != count)
        throw UsageError(fmt::format("{}: there are {} for {} faces; give one for each", name, values.size(), count));
    return {values.data(), values.data() + values.size()};
}

Vec3 vector_of(const py::object& given, const std::string& name) {
    const auto values = converted<float>(numbers(given, name, "fiu", {3}), name);
    if (values.size() != 3) throw UsageError(name + ": three numbers are needed");
    Vec3 vector(values.at(0), values.at(1), values.at(2));
    if (!vector.allFinite()) throw UsageError(name + ": three finite numbers are needed");
    return vector;
}

py::str text(const std::string& bytes) {
    PyObject* const decoded = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace");
    if (!decoded) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(decoded);
}

py::list texts(const std::vector<std::string>& list) {
    py::list result;
    for (const std::string& bytes : list) result.append(text(bytes));
    return result;
}

void require_range(const std::string& name, std::int64_t value, std::int64_t least, std::int64_t most) {
    if (value < least || value > most)
        throw UsageError(fmt::format("{}: {} is no whole number from {} to {}", name, value, least, most));
}

void require_range(const std::string& name, double value, double least, double most) {
    if (!(value >= least && value <= most))
        throw UsageError(fmt::format("{}: {} is not from {} to {}", name, value, least, most));
}

}  // namespace exemplar::python
