#include "host/mesh/io/io_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar::mesh_io {
namespace {

/// Returns whether a number is the shortest decimal form of its float: then a program wrote it that computed in floats.
bool is_written_float(double x) {
    std::string text;
    append_number(text, static_cast<float>(x));
    return parse_number(text) == x;
}

/// The extent of a surface on one axis, and how far rounding to floats moves its corners along it.
struct AxisExtent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity(), loss = 0;

    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
        const double moved = std::abs(x - double{static_cast<float>(x)});
        if (moved > loss && moved > k_loss * (high - low) && !is_written_float(x)) loss = moved;
    }
    double extent() const { return high > low ? high - low : 0; }
    bool is_flat(double largest) const { return extent() <= largest / (1 << 20); }
    bool loses(double largest) const { return !is_flat(largest) && loss > k_loss * extent(); }
    /// Returns the middle, as a multiple of a power of two about as large as the extent: differences are then exact.
    double middle(double largest) const {
        const double step = std::exp2(std::ceil(std::log2(is_flat(largest) ? largest : extent())));
        return std::round((low + high) / 2 / step) * step;
    }

    static constexpr double k_loss = 1.0 / 65536;
};

}  // namespace

Vec3d origin_for_floats(std::span<const Vec3d> positions, std::span<const std::uint32_t> corners) {
    std::array<AxisExtent, 3> axes;
    for (const std::uint32_t v : corners) {
        if (!positions[v].cast<float>().allFinite()) continue;
        for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)].add(positions[v][i]);
    }
    const double largest = std::max({axes[0].extent(), axes[1].extent(), axes[2].extent()});
    if (std::ranges::none_of(axes, [&](const AxisExtent& axis) { return axis.loses(largest); })) return Vec3d::Zero();
    return {axes[0].middle(largest), axes[1].middle(largest), axes[2].middle(largest)};
}

std::string far_position_warning(const TriangleMesh& mesh) {
    constexpr double k_far = 2000;  // about 4000 steps of floats across the mesh
    const BoundingBox box = bounding_box(mesh);
    const double size = box.diagonal();
    if (!(size > 0) || !std::isfinite(size)) return {};
    const double distance = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
    if (!(distance > k_far * size)) return {};
    return fmt::format(
        "the mesh is {:.2g} times its size away from the origin, which leaves floats about {:.0f} steps across it; "
        "move "
        "it to the origin before it is saved",
        distance / size, size / (distance * std::numeric_limits<float>::epsilon()));
}

std::string degrees_warning(const TriangleMesh& mesh) {
    constexpr double k_needle = 1000;
    const BoundingBox box = bounding_box(mesh);
    const Vec3d extent = box.high - box.low;
    int degrees = 0;
    for (int i = 0; i < 3; ++i)
        degrees += mesh.origin[i] != 0 && std::abs(mesh.origin[i]) <= 180 && extent[i] * k_needle < extent.maxCoeff();
    if (degrees < 2) return {};
    return fmt::format(
        "the mesh is a needle of {:.2g} x {:.2g} x {:.2g}; if its coordinates are degrees of longitude and latitude, "
        "project them to meters",
        extent[0], extent[1], extent[2]);
}

}  // namespace exemplar::mesh_io
