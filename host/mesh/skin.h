#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// An affine map: a linear part and a translation.
template <typename Scalar>
using AffineOf = Eigen::Transform<Scalar, 3, Eigen::AffineCompact>;
using Affine = AffineOf<float>;
using Affine3 = AffineOf<double>;

/// A node that vertices are bound to: a joint of a skin, or a node that carries a mesh without a skin.
struct Bone {
    std::uint32_t node = 0;
    Affine inverse_bind = Affine::Identity();  ///< from the space of the rest mesh to that of the node
};

struct Influence {
    std::uint32_t bone = 0;
    float weight = 0;  ///< in (0, 1]; those of a vertex sum to one
};

/// A blend shape: offsets that are added to the rest vertices at full weight. Vertices that it does not move are
/// left out.
struct MorphTarget {
    std::string name;
    std::vector<std::uint32_t> vertices;  ///< in increasing order
    std::vector<Vec3> offsets;            ///< one per entry of `vertices`
    float rest_weight = 0;
};

/// How the vertices of a surface follow nodes and morph weights: v = sum_b w_b world(b) inverse_bind_b (rest_v + sum_t
/// weight_t offset_tv), linear blend skinning after morphing, as glTF 2.0 defines it.
struct Skin {
    std::vector<Bone> bones;
    /// Compressed rows: the influences on vertex v are influences[influence_begin[v] .. influence_begin[v + 1]), by
    /// increasing bone; at least one each.
    std::vector<std::uint32_t> influence_begin;
    std::vector<Influence> influences;
    std::vector<MorphTarget> targets;

    std::span<const Influence> influences_of(std::size_t v) const {
        return {influences.data() + influence_begin[v], influences.data() + influence_begin[v + 1]};
    }
};

/// Brings the influences of a skin into the form that Skin promises: by increasing bone, each at least 1e-4, summing
/// to one. A vertex without weight is bound to the first bone that it lists (with whatever weight), else to the
/// first of all. Appends warnings; throws MeshError that begins with `name` if a weight is not finite or a bone does
/// not exist.
void clean_influences(Skin& skin, const std::string& name, std::vector<std::string>& warnings);

/// Adds the morph targets to the vertices of `rest`, with a weight each, before skinning.
void morph(const Skin& skin, std::span<const Vec3> rest, std::span<const float> weights, std::vector<Vec3>& out);

/// Moves morphed vertices by linear blend skinning. `bones` has world(b) inverse_bind_b for each bone. For float (the
/// reference of the device's kernels) and double.
template <typename Scalar>
void skin_vertices(const Skin& skin, const std::vector<AffineOf<Scalar>>& bones, std::vector<Vec3>& vertices);

}  // namespace exemplar
