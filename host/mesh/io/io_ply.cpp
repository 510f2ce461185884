// Reads PLY: a header that declares elements and their properties, then the values as text or binary.
#include "host/mesh/io/io_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Reads values from a text body, which has a line per element.
class AsciiValues {
  public:
    AsciiValues(std::string_view content, const std::string& name, const PlyHeader& header) : cursor_(content, name) {
        cursor_.jump(header.bytes, header.lines);
    }
    void begin_row(const std::string& element) { cursor_.need_line(element); }
    double value(PlyScalar type, const std::string& property) {
        if (is_integer(type)) return static_cast<double>(cursor_.integer(property));
        return cursor_.number(property);
    }
    /// Returns the maximum number of values of a type that can still follow in the row.
    std::uint64_t max_values(PlyScalar) const { return (cursor_.rest().size() + 1) / 2; }
    std::uint64_t max_rows(const PlyElement& element) const {
        return (cursor_.bytes_left() + 1) / (2 * element.properties.size());
    }
    [[noreturn]] void fail(const std::string& message) const { cursor_.fail(message); }
    std::size_t bytes_left() { return cursor_.next_line() ? cursor_.rest().size() + cursor_.bytes_left() : 0; }

  private:
    TextCursor cursor_;
};

/// Reads values from a binary body.
class BinaryValues {
  public:
    BinaryValues(std::string_view content, const std::string& name, const PlyHeader& header)
        : content_(content),
          name_(name),
          at_(header.bytes),
          swap_((header.encoding == PlyEncoding::big_endian) != (std::endian::native == std::endian::big)) {}
    void begin_row(const std::string&) {}
    double value(PlyScalar type, const std::string& property) {
        switch (type) {
            case PlyScalar::int8:
                return take<std::int8_t>(property);
            case PlyScalar::uint8:
                return take<std::uint8_t>(property);
            case PlyScalar::int16:
                return take<std::int16_t>(property);
            case PlyScalar::uint16:
                return take<std::uint16_t>(property);
            case PlyScalar::int32:
                return take<std::int32_t>(property);
            case PlyScalar::uint32:
                return take<std::uint32_t>(property);
            case PlyScalar::float32:
                return take<float>(property);
            case PlyScalar::float64:
                return take<double>(property);
        }
        fail("unknown type");
    }
    std::uint64_t max_values(PlyScalar type) const { return bytes_left() / byte_size(type); }
    std::uint64_t max_rows(const PlyElement& element) const {
        std::size_t row_bytes = 0;
        for (const PlyProperty& p : element.properties) row_bytes += byte_size(p.count_type.value_or(p.type));
        return bytes_left() / row_bytes;
    }
    [[noreturn]] void fail(const std::string& message) const {
        mesh_io::fail(name_, fmt::format("byte {}: {}", at_, message));
    }
    std::size_t bytes_left() const { return content_.size() - at_; }

  private:
    template <typename T>
    T take(const std::string& property) {
        if (bytes_left() < sizeof(T)) fail(fmt::format("the file is cut off in property {}", property));
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), content_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        if (swap_) std::ranges::reverse(bytes);
        return std::bit_cast<T>(bytes);
    }
    std::string_view content_;
    std::string name_;
    std::size_t at_;
    bool swap_;
};

/// The meaning of a property for a mesh.
enum class Role { none, x, y, z, corners, strips, label, confidence };

bool is_index_list(const PlyProperty& property) {
    const bool named = property.name == "vertex_indices" || property.name == "vertex_index";
    return named && property.count_type && is_integer(property.type);
}

Role role_of(const PlyElement& element, const PlyProperty& property) {
    if (element.name == "vertex" && !property.count_type) {
        if (property.name == "x") return Role::x;
        if (property.name == "y") return Role::y;
        if (property.name == "z") return Role::z;
    }
    if (element.name == "face") {
        if (is_index_list(property)) return Role::corners;
        if (property.name == "label" && !property.count_type) return Role::label;
        if (property.name == "confidence" && !property.count_type) return Role::confidence;
    }
    if (element.name == "tristrips" && is_index_list(property)) return Role::strips;
    return Role::none;
}

std::vector<Role> roles_of(const PlyElement& element) {
    std::vector<Role> roles;
    for (const PlyProperty& property : element.properties) roles.push_back(role_of(element, property));
    return roles;
}

struct PlyContent {
    PolygonList polygons;
    std::vector<std::int32_t> labels;  ///< per polygon, if has_labels
    std::vector<float> confidence;     ///< per polygon, if has_confidence
    bool has_labels = false, has_confidence = false;
};

/// Reads the body of one file; Values is AsciiValues or BinaryValues.
template <typename Values>
class BodyReader {
  public:
    BodyReader(Values values, const std::string& name, const PlyHeader& header)
        : values_(std::move(values)), name_(name), header_(header) {}

    PlyContent read(std::vector<std::string>& warnings) {
        check_declarations();
        for (const PlyElement& element : header_.elements) read_element(element);
        if (const std::size_t left = values_.bytes_left())
            warnings.push_back(fmt::format("{} bytes after the last element were left out", left));
        return std::move(content_);
    }

  private:
    void check_declarations() {
        for (const PlyElement& element : header_.elements) {
            const std::vector<Role> roles = roles_of(element);
            for (Role role : {Role::x, Role::y, Role::z, Role::corners, Role::strips, Role::label, Role::confidence})
                if (std::ranges::count(roles, role) > 1)
                    mesh_io::fail(
                        name_,
                        fmt::format("element {} declares coordinates, vertex indices, confidences or labels twice",
                                    element.name));
            const auto need = [&](Role role, const char* what) {
                if (std::ranges::find(roles, role) == roles.end())
                    mesh_io::fail(name_, fmt::format("element {} has no property {}", element.name, what));
            };
            if (element.name == "vertex") {
                need(Role::x, "x");
                need(Role::y, "y");
                need(Role::z, "z");
                vertex_count_ = element.count;
            } else if (element.name == "face") {
                if (element.count > 0) need(Role::corners, "vertex_indices that is a list of integers");
                content_.has_labels = std::ranges::find(roles, Role::label) != roles.end();
                content_.has_confidence = std::ranges::find(roles, Role::confidence) != roles.end();
            } else if (element.name == "tristrips") {
                need(Role::strips, "vertex_indices that is a list of integers");
            }
        }
        if (!vertex_count_) mesh_io::fail(name_, "the header declares no vertices");
    }

    void read_element(const PlyElement& element) {
        if (element.properties.empty()) return;
        if (element.count > values_.max_rows(element))
            mesh_io::fail(name_,
                          fmt::format("{} rows of element {} cannot be in what is left of the file; the count is wrong "
                                      "or the file is cut off",
                                      element.count, element.shown));
        const std::vector<Role> roles = roles_of(element);
        if (element.name == "vertex") content_.polygons.positions.reserve(element.count);
        if (element.name == "face") content_.polygons.reserve_polygons(element.count);
        for (row_ = 0; row_ < element.count; ++row_) {
            values_.begin_row(element.shown);
            for (std::size_t p = 0; p < roles.size(); ++p) read_property(element.properties[p], roles[p]);
            if (element.name == "vertex") content_.polygons.positions.push_back(position_);
            if (element.name == "face") content_.polygons.add(corners_);
            if (element.name == "tristrips") end_strip();
        }
    }

    /// Adds the triangles of a strip. Every other one is reversed. Those that only join two parts of the strip (a
    /// vertex occurs twice) count but are left out.
    void end_strip() {
        for (std::size_t i = 2; i < corners_.size(); ++i) {
            std::array<std::uint32_t, 3> triangle{corners_[i - 2], corners_[i - 1], corners_[i]};
            if (i % 2) std::swap(triangle[0], triangle[1]);
            const auto [a, b, c] = triangle;
            if (a == b || b == c || c == a) continue;
            content_.polygons.add(triangle);
            if (content_.has_labels) content_.labels.push_back(-1);
            if (content_.has_confidence) content_.confidence.push_back(std::numeric_limits<float>::quiet_NaN());
        }
        corners_.clear();
    }

    void read_property(const PlyProperty& property, Role role) {
        if (property.count_type) {
            read_list(property, role);
            return;
        }
        const double value = values_.value(property.type, property.shown);
        switch (role) {
            case Role::x:
                position_.x() = value;
                break;
            case Role::y:
                position_.y() = value;
                break;
            case Role::z:
                position_.z() = value;
                break;
            case Role::label:
                add_label(value);
                break;
            case Role::confidence:
                content_.confidence.push_back(static_cast<float>(value));
                break;
            default:
                break;
        }
    }

    void read_list(const PlyProperty& property, Role role) {
        const double count = values_.value(*property.count_type, property.shown);
        if (count < 0 || count > static_cast<double>(values_.max_values(property.type)))
            values_.fail(fmt::format(
                "a list of {} items cannot be in what is left; the count is wrong or the file is cut off", count));
        const bool wanted = role == Role::corners || role == Role::strips;
        if (wanted) corners_.clear();
        for (auto i = static_cast<std::uint64_t>(count); i > 0; --i) {
            const double value = values_.value(property.type, property.shown);
            if (!wanted) continue;
            if (role == Role::strips && value == -1) {
                end_strip();
                continue;
            }
            if (value < 0 || value >= static_cast<double>(*vertex_count_))
                values_.fail(fmt::format("{} {} names vertex {}, but the file has {} vertices, counted from 0",
                                         role == Role::strips ? "strip" : "face", row_, value, *vertex_count_));
            corners_.push_back(static_cast<std::uint32_t>(value));
        }
    }

    void add_label(double value) {
        if (value != std::floor(value) || std::abs(value) > std::numeric_limits<std::int32_t>::max())
            values_.fail(fmt::format("label {} of face {} is not a 32-bit integer", value, row_));
        content_.labels.push_back(static_cast<std::int32_t>(value));
    }

    Values values_;
    const std::string& name_;
    const PlyHeader& header_;
    PlyContent content_;
    std::optional<std::uint64_t> vertex_count_;
    std::uint64_t row_ = 0;
    Vec3d position_ = Vec3d::Zero();
    std::vector<std::uint32_t> corners_;
};

/// Names every value that occurs or that a comment names, in increasing order, and renumbers the faces accordingly.
/// Numbers stay if the comments name 0 .. n-1 and no other value occurs. Negative values are unlabeled.
FaceLabels named_labels(std::vector<std::int32_t> values, const std::map<std::int64_t, std::string>& comments) {
    std::vector<std::int64_t> indices;
    for (const auto& [index, name] : comments)
        if (index >= 0) indices.push_back(index);
    std::vector<std::int32_t> distinct = values;
    std::ranges::sort(distinct);
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    for (std::int32_t value : distinct)
        if (value >= 0) indices.push_back(value);
    std::ranges::sort(indices);
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    FaceLabels labels;
    for (std::int64_t index : indices) {
        const auto comment = comments.find(index);
        labels.names.push_back(comment != comments.end() ? comment->second : std::to_string(index));
    }
    for (std::int32_t& value : values)
        value =
            value < 0
                ? -1
                : static_cast<std::int32_t>(std::ranges::lower_bound(indices, std::int64_t{value}) - indices.begin());
    labels.label = std::move(values);
    return labels;
}

}  // namespace

MeshFile read_ply(std::string_view content, const std::string& name) {
    const PlyHeader header = read_ply_header(content, name);
    MeshFile file;
    PlyContent body = header.encoding == PlyEncoding::ascii
                          ? BodyReader(AsciiValues(content, name, header), name, header).read(file.warnings)
                          : BodyReader(BinaryValues(content, name, header), name, header).read(file.warnings);
    std::move(body.polygons).triangulate_into(file);
    if (body.has_labels) file.labels = named_labels(std::move(body.labels), header.label_names);
    file.confidence = std::move(body.confidence);
    return file;
}

}  // namespace exemplar::mesh_io
