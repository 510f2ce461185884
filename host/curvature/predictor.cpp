#include "host/curvature/predictor.h"

#include <Eigen/Geometry>
#include <cmath>

namespace exemplar {

namespace {

constexpr int k_half_lanes = 8;

/// A number for each of eight vertices.
using Lanes = EightFloats;
using LaneVectors = std::array<Lanes, 3>;
/// Not an expression: those hold references to temporaries.
using Mask = Eigen::Array<bool, k_half_lanes, 1>;

Lanes dot(const LaneVectors& a, const LaneVectors& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
LaneVectors cross(const LaneVectors& a, const LaneVectors& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
LaneVectors combined(const Lanes& s, const LaneVectors& a, const Lanes& t, const LaneVectors& b) {
    return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

/// One attribute of half a tile.
Lanes reproject_lanes(const BasisTiles& tiles, std::span<const float> z, std::size_t row, std::size_t half) {
    const std::size_t offset = half * k_half_lanes;
    Lanes sum = eight_from_halves(tiles.mean.data() + row * BasisTiles::k_lanes + offset);
    const Half* basis = tiles.basis.data() + tiles.entry_begin[row] * BasisTiles::k_lanes + offset;
    for (std::uint32_t e = tiles.entry_begin[row]; e < tiles.entry_begin[row + 1]; ++e, basis += BasisTiles::k_lanes)
        sum += eight_from_halves(basis) * z[tiles.component[e]];
    return sum;
}

/// any_tangent of eight unit vectors.
LaneVectors any_tangent(const LaneVectors& n) {
    const Lanes sign = (n[2] >= 0).select(Lanes::Ones(), -Lanes::Ones());
    const Lanes a = -(sign + n[2]).inverse();
    return {1 + sign * n[0] * n[0] * a, sign * n[0] * n[1] * a, -sign * n[0]};
}

LaneVectors gathered(std::span<const Vec3> vectors, const std::uint32_t* at) {
    LaneVectors result;
    for (int lane = 0; lane < k_half_lanes; ++lane)
        for (std::size_t i = 0; i < 3; ++i) result[i][lane] = vectors[at[lane]][static_cast<Eigen::Index>(i)];
    return result;
}

LaneVectors turned_by(const Eigen::Matrix3f& rotation, const LaneVectors& v) {
    LaneVectors result;
    for (int i = 0; i < 3; ++i)
        result[static_cast<std::size_t>(i)] = rotation(i, 0) * v[0] + rotation(i, 1) * v[1] + rotation(i, 2) * v[2];
    return result;
}

/// edge_tangent of eight vertices.
LaneVectors edge_tangents(const LaneVectors& edge, const LaneVectors& normal) {
    const LaneVectors flat = combined(Lanes::Ones(), edge, -dot(normal, edge), normal);
    const Lanes squared = dot(flat, flat);
    const Mask lies = squared > k_least_flat * dot(edge, edge);
    const Lanes inverse = squared.sqrt().inverse();
    const LaneVectors other = any_tangent(normal);
    LaneVectors result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = lies.select(flat[i] * inverse, other[i]);
    return result;
}

/// principal_turn of eight forms.
void principal_lanes(const Lanes& f11, const Lanes& f12, const Lanes& f22, Lanes& k1, Lanes& k2, Lanes& cosine,
                     Lanes& sine) {
    const Lanes difference = 0.5f * (f11 - f22), mean = 0.5f * (f11 + f22);
    const Lanes radius = (difference * difference + f12 * f12).sqrt();
    k1 = mean + radius;
    k2 = mean - radius;
    const Lanes inverse = (radius > 0).select(radius.inverse(), Lanes::Zero());
    const Lanes larger = (0.5f * (1 + difference.abs() * inverse)).sqrt();
    const Lanes smaller = 0.5f * f12 * inverse / larger;
    const Mask is_bent = radius > 0;
    cosine = (difference >= 0).select(larger, smaller);
    sine = (difference >= 0).select(smaller, larger);
    cosine = is_bent.select(cosine, Lanes::Ones());
    sine = is_bent.select(sine, Lanes::Zero());
}

std::array<Lanes, 4> turned_lanes(const std::array<Lanes, 4>& d, const Lanes& c, const Lanes& s) {
    const Lanes cc = c * c, ss = s * s, ccc = cc * c, ccs = cc * s, css = c * ss, sss = ss * s;
    return {ccc * d[0] + 3 * ccs * d[1] + 3 * css * d[2] + sss * d[3],
            -ccs * d[0] + (ccc - 2 * css) * d[1] + (2 * ccs - sss) * d[2] + css * d[3],
            css * d[0] + (sss - 2 * ccs) * d[1] + (ccc - 2 * css) * d[2] + ccs * d[3],
            -sss * d[0] + 3 * css * d[1] - 3 * ccs * d[2] + ccc * d[3]};
}

/// What is known of eight vertices.
struct LaneCurvature {
    Lanes k1, k2;
    LaneVectors e1;
    std::array<Lanes, 4> derivative;
};

void store_lanes(const std::uint32_t* vertex, const LaneCurvature& lanes, const LaneVectors& normal,
                 VertexCurvature& curvature) {
    const LaneVectors e2 = cross(normal, lanes.e1);
    for (int lane = 0; lane < k_half_lanes; ++lane) {
        const std::uint32_t v = vertex[lane];
        const auto at = [&](const LaneVectors& e) { return Vec3(e[0][lane], e[1][lane], e[2][lane]); };
        curvature.k1[v] = lanes.k1[lane];
        curvature.k2[v] = lanes.k2[lane];
        curvature.e1[v] = at(lanes.e1);
        curvature.e2[v] = at(e2);
        for (std::size_t k = 0; k < 4; ++k) curvature.derivative[v][k] = lanes.derivative[k][lane];
    }
}

/// The tensor set: seven attributes of eight vertices, in the frame of an edge.
LaneCurvature decode_tensor(const std::array<Lanes, k_most_attributes>& y, const LaneVectors& edge,
                            const LaneVectors& normal) {
    const LaneVectors tangent = edge_tangents(edge, normal);
    LaneCurvature result;
    Lanes cosine, sine;
    principal_lanes(y[0], y[1], y[2], result.k1, result.k2, cosine, sine);
    result.e1 = combined(cosine, tangent, sine, cross(normal, tangent));
    result.derivative = turned_lanes({y[3], y[4], y[5], y[6]}, cosine, sine);
    return result;
}

/// e1 of eight vertices from its two kept coordinates (see AttributeFrames): the third makes it orthogonal to the
/// normal.
LaneVectors completed_direction(const Lanes& first, const Lanes& second, const LaneVectors& n,
                                const LaneVectors& reference) {
    const auto& [rx, ry, rz] = reference;
    const Mask drop_x = rx.abs() >= ry.abs() && rx.abs() >= rz.abs();
    const Mask drop_y = !drop_x && ry.abs() >= rz.abs();
    const Lanes zero = Lanes::Zero();
    LaneVectors e{drop_x.select(zero, first), drop_x.select(first, drop_y.select(zero, second)),
                  (drop_x || drop_y).select(second, zero)};
    const Lanes dropped = drop_x.select(n[0], drop_y.select(n[1], n[2]));
    const Lanes bounded = (dropped >= 0).select(dropped.max(k_least_divisor), dropped.min(-k_least_divisor));
    const Lanes missing = -dot(n, e) / bounded;
    e[0] = drop_x.select(missing, e[0]);
    e[1] = drop_y.select(missing, e[1]);
    e[2] = (drop_x || drop_y).select(e[2], missing);
    e = combined(Lanes::Ones(), e, -dot(n, e), n);
    const Lanes length = dot(e, e).sqrt();
    const LaneVectors other = any_tangent(n);
    for (std::size_t i = 0; i < 3; ++i) e[i] = (length > 1e-6f).select(e[i] / length, other[i]);
    return e;
}

/// The thesis' eight attributes, given normals in the world.
LaneCurvature decode_principal(const BasisTiles& tiles, const std::array<Lanes, k_most_attributes>& y, std::size_t tile,
                               std::size_t half, const LaneVectors& normal, const Eigen::Matrix3f& rotation) {
    LaneVectors reference;
    for (std::size_t i = 0; i < 3; ++i)
        reference[i] =
            eight_from_halves(tiles.reference.data() + (tile * 3 + i) * BasisTiles::k_lanes + half * k_half_lanes);
    const LaneVectors e1 = completed_direction(y[2], y[3], turned_by(rotation.transpose(), normal), reference);
    return {y[0].max(y[1]), y[0].min(y[1]), turned_by(rotation, e1), {y[4], y[5], y[6], y[7]}};
}

}  // namespace

void ComponentRegression::evaluate(std::span<const float> x, std::span<float> features, std::span<float> z) const {
    const auto input = [&](std::uint32_t i) { return i < x.size() ? x[i] : 1.0f; };
    for (std::size_t m = 0; m < monomials.size(); ++m)
        features[m] = input(monomials[m][0]) * input(monomials[m][1]) * input(monomials[m][2]);
    if (neurons.rows() > 0) {
        const Eigen::Map<const Eigen::VectorXf> in(x.data(), static_cast<Eigen::Index>(x.size()));
        Eigen::Map<Eigen::ArrayXf>(features.data() + monomials.size(), neurons.rows()) =
            (neurons * in + neuron_bias).array().tanh();
    }
    for (std::size_t c = 0; c < components.size(); ++c) {
        const Component& part = components[c];
        z[c] = Eigen::Map<const Eigen::VectorXf>(features.data() + part.first_feature, part.feature_count)
                   .dot(Eigen::Map<const Eigen::VectorXf>(coefficients.data() + part.first_coefficient,
                                                          part.feature_count));
    }
}

std::size_t BasisTiles::bytes() const {
    return vertex.size() * sizeof(vertex[0]) + segment.size() * sizeof(segment[0]) +
           entry_begin.size() * sizeof(entry_begin[0]) + component.size() * sizeof(component[0]) +
           (basis.size() + mean.size() + reference.size()) * sizeof(Half) + neighbor.size() * sizeof(neighbor[0]);
}

void reproject(const BasisTiles& tiles, std::span<const float> z, std::span<float> attributes) {
    const std::size_t count = attribute_count(tiles.set);
    for (std::size_t t = 0; t < tiles.tile_count(); ++t)
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t half = 0; half < 2; ++half) {
                const Lanes y = tiles.scale[a] * reproject_lanes(tiles, z, t * count + a, half);
                const std::uint32_t* const vertex = tiles.vertex.data() + t * BasisTiles::k_lanes + half * k_half_lanes;
                for (int lane = 0; lane < k_half_lanes; ++lane)
                    attributes[a * tiles.vertex_count + vertex[lane]] = y[lane];
            }
}

void reproject_curvature(const BasisTiles& tiles, std::span<const float> z, const PosedSurface& surface,
                         VertexCurvature& curvature) {
    const std::size_t count = attribute_count(tiles.set);
    curvature.k1.resize(tiles.vertex_count);
    curvature.k2.resize(tiles.vertex_count);
    curvature.e1.resize(tiles.vertex_count);
    curvature.e2.resize(tiles.vertex_count);
    curvature.derivative.resize(tiles.vertex_count);
    std::array<Lanes, k_most_attributes> y;
    for (std::size_t t = 0; t < tiles.tile_count(); ++t)
        for (std::size_t half = 0; half < 2; ++half) {
            for (std::size_t a = 0; a < count; ++a)
                y[a] = tiles.scale[a] * reproject_lanes(tiles, z, t * count + a, half);
            const std::size_t first = t * BasisTiles::k_lanes + half * k_half_lanes;
            const std::uint32_t* const vertex = tiles.vertex.data() + first;
            const LaneVectors normal = gathered(surface.normals, vertex);
            if (tiles.set == AttributeSet::tensor) {
                LaneVectors edge = gathered(surface.vertices, tiles.neighbor.data() + first);
                const LaneVectors from = gathered(surface.vertices, vertex);
                for (std::size_t i = 0; i < 3; ++i) edge[i] -= from[i];
                store_lanes(vertex, decode_tensor(y, edge, normal), normal, curvature);
            } else {
                store_lanes(vertex, decode_principal(tiles, y, t, half, normal, surface.rotations[tiles.segment[t]]),
                            normal, curvature);
            }
        }
}

}  // namespace exemplar
