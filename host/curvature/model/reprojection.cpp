// reproject_curvature, which every frame runs: tiles of sixteen vertices, in SIMD vectors of eight. reproject() and
// AttributeFrames::decode() are its plain reference.

#include <array>
#include <cstring>

#include "host/core/eight.h"
#include "host/curvature/model/predictor.h"

namespace exemplar {

namespace {

constexpr std::size_t k_lanes = BasisTiles::k_lanes, k_eight = 8;
static_assert(k_lanes == 2 * k_eight);

/// One vector for each of eight vertices.
struct EightVectors {
    EightFloats x, y, z;
};
EightVectors operator+(const EightVectors& a, const EightVectors& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
EightVectors operator-(const EightVectors& a, const EightVectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
EightVectors operator*(const EightFloats& s, const EightVectors& a) {
    return {s * a.x, s * a.y, s * a.z};
}
EightFloats dot(const EightVectors& a, const EightVectors& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
EightVectors cross(const EightVectors& a, const EightVectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
EightVectors chosen(EightBits mask, const EightVectors& yes, const EightVectors& no) {
    return {mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z};
}
EightVectors turned_by(const Eigen::Matrix3f& r, const EightVectors& v) {
    return {r(0, 0) * v.x + r(0, 1) * v.y + r(0, 2) * v.z, r(1, 0) * v.x + r(1, 1) * v.y + r(1, 2) * v.z,
            r(2, 0) * v.x + r(2, 1) * v.y + r(2, 2) * v.z};
}

void store(FourFloats row, Vec3& v) {
    const TwoFloats xy = __builtin_shufflevector(row, row, 0, 1);
    std::memcpy(v.data(), &xy, sizeof(xy));
    v.z() = row[2];
}

EightVectors gathered(std::span<const Vec3> vectors, const std::uint32_t* at) {
    const auto row = [&](std::size_t i) { return load_three(vectors[at[i]].data()); };
    const FourEights m =
        transposed({joined(row(0), row(4)), joined(row(1), row(5)), joined(row(2), row(6)), joined(row(3), row(7))});
    return {m.a, m.b, m.c};
}

/// The curvature of eight vertices.
struct EightCurvatures {
    EightFloats k1, k2;
    EightVectors e1;
    FourEights derivative;
};

void store_vertex(std::uint32_t v, FourFloats first, FourFloats second, FourFloats derivative, VertexCurvature& out) {
    store(first, out.e1[v]);
    store(second, out.e2[v]);
    out.k1[v] = first[3];
    out.k2[v] = second[3];
    std::memcpy(out.derivative[v].data(), &derivative, sizeof(derivative));
}
void store(const std::uint32_t* at, const EightCurvatures& eight, const EightVectors& normal, VertexCurvature& out) {
    const EightVectors e2 = cross(normal, eight.e1);
    const FourEights first = transposed({eight.e1.x, eight.e1.y, eight.e1.z, eight.k1}),
                     second = transposed({e2.x, e2.y, e2.z, eight.k2}), derivative = transposed(eight.derivative);
    const auto store_two = [&](std::size_t i, EightFloats f, EightFloats s, EightFloats d) {
        store_vertex(at[i], low_half(f), low_half(s), low_half(d), out);
        store_vertex(at[i + 4], high_half(f), high_half(s), high_half(d), out);
    };
    store_two(0, first.a, second.a, derivative.a);
    store_two(1, first.b, second.b, derivative.b);
    store_two(2, first.c, second.c, derivative.c);
    store_two(3, first.d, second.d, derivative.d);
}

/// One attribute of the sixteen vertices of a tile.
struct Sixteen {
    std::array<EightFloats, 2> eights;
};

/// The attributes of eight vertices.
using EightAttributes = std::array<EightFloats, k_max_attributes>;

Sixteen sixteen_from_halves(const Half* halves) {
    return {{eight_from_halves(halves), eight_from_halves(halves + k_eight)}};
}
void add_product(float factor, const std::int8_t* basis, Sixteen& sum) {
    sum.eights[0] += factor * eight_from_bytes(basis);
    sum.eights[1] += factor * eight_from_bytes(basis + k_eight);
}

/// Computes a row, one attribute of a tile. Two alternating sums shorten the chain of dependent additions.
Sixteen reprojected(const BasisTiles& tiles, std::span<const float> z, std::size_t row, float scale) {
    Sixteen even = sixteen_from_halves(tiles.mean.data() + row * k_lanes), odd{};
    even.eights[0] *= scale;
    even.eights[1] *= scale;
    const std::uint32_t* next = tiles.entry.data() + tiles.entry_begin[row];
    const std::uint32_t* const end = tiles.entry.data() + tiles.entry_begin[row + 1];
    const std::int8_t* basis = tiles.basis.data() + tiles.entry_begin[row] * k_lanes;
    const auto factor = [&](std::uint32_t entry) {
        return z[BasisTiles::component_of(entry)] * BasisTiles::step_of(entry);
    };
    for (; end - next >= 2; next += 2, basis += 2 * k_lanes) {
        add_product(factor(next[0]), basis, even);
        add_product(factor(next[1]), basis + k_lanes, odd);
    }
    if (next != end) add_product(factor(*next), basis, even);
    return {{even.eights[0] + odd.eights[0], even.eights[1] + odd.eights[1]}};
}

std::array<EightAttributes, 2> tile_attributes(const BasisTiles& tiles, std::span<const float> z, std::size_t tile) {
    std::array<EightAttributes, 2> y;
    const std::size_t count = attribute_count(tiles.set);
    for (std::size_t a = 0; a < count; ++a) {
        const Sixteen row = reprojected(tiles, z, tile * count + a, tiles.scale[a]);
        for (std::size_t half = 0; half < 2; ++half) y[half][a] = row.eights[half];
    }
    return y;
}

/// Computes frame_of_normal(n).tangent.
EightVectors any_tangent(const EightVectors& n) {
    const EightFloats sign = n.z >= 0 ? eight_of(1) : eight_of(-1), a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// Computes edge_tangent.
EightVectors edge_tangents(const EightVectors& edge, const EightVectors& normal) {
    const EightVectors flat = edge - dot(normal, edge) * normal;
    const EightFloats squared = dot(flat, flat);
    return chosen(squared > k_min_flatness * dot(edge, edge), (1 / square_root(squared)) * flat, any_tangent(normal));
}

/// Computes principal_rotation. Half the angle of (x, y) is the angle of (length + x, y) and of (y, length - x); the
/// one without cancellation is used.
void principal_turns(EightFloats f11, EightFloats f12, EightFloats f22, EightCurvatures& out, EightFloats& cosine,
                     EightFloats& sine) {
    const EightFloats difference = 0.5f * (f11 - f22), mean = 0.5f * (f11 + f22),
                      radius = square_root(difference * difference + f12 * f12);
    out.k1 = mean + radius;
    out.k2 = mean - radius;
    const EightFloats sum = radius + magnitude(difference), squared = 2 * radius * sum;
    const EightFloats inverse = 1 / square_root(squared), larger = sum * inverse, smaller = f12 * inverse;
    const EightBits is_bent = squared > 0, is_right = difference >= 0;
    cosine = is_bent ? (is_right ? larger : smaller) : eight_of(1);
    sine = is_bent ? (is_right ? smaller : larger) : EightFloats{};
}

/// Computes turned(derivative, turn).
FourEights in_rotated_frame(const FourEights& d, EightFloats c, EightFloats s) {
    const EightFloats cc = c * c, ss = s * s, ccc = cc * c, ccs = cc * s, css = c * ss, sss = ss * s;
    return {ccc * d.a + 3 * ccs * d.b + 3 * css * d.c + sss * d.d,
            -ccs * d.a + (ccc - 2 * css) * d.b + (2 * ccs - sss) * d.c + css * d.d,
            css * d.a + (sss - 2 * ccs) * d.b + (ccc - 2 * css) * d.c + ccs * d.d,
            -sss * d.a + 3 * css * d.b - 3 * ccs * d.c + ccc * d.d};
}

/// Decodes the tensor set: seven attributes of eight vertices, in the frame of an edge.
EightCurvatures decode_tensor(const EightAttributes& y, const EightVectors& edge, const EightVectors& normal) {
    EightCurvatures result;
    EightFloats cosine, sine;
    principal_turns(y[0], y[1], y[2], result, cosine, sine);
    const EightVectors tangent = edge_tangents(edge, normal);
    result.e1 = cosine * tangent + sine * cross(normal, tangent);
    result.derivative = in_rotated_frame({y[3], y[4], y[5], y[6]}, cosine, sine);
    return result;
}

/// Computes e1 of eight vertices from its two kept coordinates (see AttributeFrames): the third one makes it
/// orthogonal to the normal.
EightVectors completed_direction(EightFloats first, EightFloats second, const EightVectors& n,
                                 const EightVectors& reference) {
    const EightFloats rx = magnitude(reference.x), ry = magnitude(reference.y), rz = magnitude(reference.z), zero{};
    const EightBits drop_x = (rx >= ry) & (rx >= rz), drop_y = ~drop_x & (ry >= rz), keep_z = drop_x | drop_y;
    EightVectors e{drop_x ? zero : first, drop_x ? first : (drop_y ? zero : second), keep_z ? second : zero};
    const EightFloats dropped = drop_x ? n.x : (drop_y ? n.y : n.z), least = eight_of(k_min_divisor);
    const EightFloats size = magnitude(dropped) > least ? magnitude(dropped) : least;
    const EightFloats missing = -dot(n, e) / (dropped >= 0 ? size : -size);
    e = {drop_x ? missing : e.x, drop_y ? missing : e.y, keep_z ? e.z : missing};
    e = e - dot(n, e) * n;
    const EightFloats length = square_root(dot(e, e));
    return chosen(length > 1e-6f, (1 / length) * e, any_tangent(n));
}

EightVectors vectors_from_halves(const Half* x, std::size_t stride) {
    return {eight_from_halves(x), eight_from_halves(x + stride), eight_from_halves(x + 2 * stride)};
}

/// Decodes the principal set: the thesis' eight attributes of eight vertices, given normals in world space.
EightCurvatures decode_principal(const EightAttributes& y, const EightVectors& reference, const EightVectors& normal,
                                 const Eigen::Matrix3f& rotation) {
    const EightVectors e1 = completed_direction(y[2], y[3], turned_by(rotation.transpose(), normal), reference);
    const EightBits is_in_order = y[0] >= y[1];
    return {is_in_order ? y[0] : y[1], is_in_order ? y[1] : y[0], turned_by(rotation, e1), {y[4], y[5], y[6], y[7]}};
}

}  // namespace

void reproject_curvature(const BasisTiles& tiles, std::span<const float> z, const PosedSurface& surface,
                         VertexCurvature& curvature) {
    curvature.k1.resize(tiles.vertex_count);
    curvature.k2.resize(tiles.vertex_count);
    curvature.e1.resize(tiles.vertex_count);
    curvature.e2.resize(tiles.vertex_count);
    curvature.derivative.resize(tiles.vertex_count);
    for (std::size_t t = 0; t < tiles.tile_count(); ++t) {
        const std::array<EightAttributes, 2> y = tile_attributes(tiles, z, t);
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t first = t * k_lanes + half * k_eight;
            const std::uint32_t* const vertex = &tiles.vertex[first];
            const EightVectors normal = gathered(surface.normals, vertex);
            if (tiles.set == AttributeSet::tensor) {
                const EightVectors edge =
                    gathered(surface.vertices, &tiles.neighbor[first]) - gathered(surface.vertices, vertex);
                store(vertex, decode_tensor(y[half], edge, normal), normal, curvature);
            } else {
                const Half* const reference = &tiles.reference[t * 3 * k_lanes + half * k_eight];
                store(vertex,
                      decode_principal(y[half], vectors_from_halves(reference, k_lanes), normal,
                                       surface.rotations[tiles.segment[t]]),
                      normal, curvature);
            }
        }
    }
}

}  // namespace exemplar
