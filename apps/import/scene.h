#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace exemplar::import {

/// The library holds floats; products of them are computed in doubles.
using Matrix = aiMatrix4x4t<double>;
using Position = aiVector3t<double>;

/// A node of the hierarchy. FBX describes the transform of a node by pivots and offsets, for which the library makes a
/// chain of nodes NAME_$AssimpFbx$_PART above the node NAME. Here such a chain is one node, so that the rotation of a
/// joint is that of its node.
struct SceneNode {
    std::string name;
    int parent = -1;                   ///< smaller than the node's own index; -1 at the root
    std::vector<const aiNode*> parts;  ///< of the chain, from the outermost one to the node of that name
    Matrix local, world;               ///< at rest
    bool carries_mesh = false;         ///< whether a mesh follows it or a node below it
};

/// A mesh that hangs on a node. `joints` names the node of each of its bones. It is empty for a mesh that follows its
/// node. A mesh with joints ignores the transform of its node.
struct SceneMesh {
    const aiMesh* mesh = nullptr;
    int node = 0;
    std::vector<int> joints;
};

struct Scene {
    std::vector<SceneNode> nodes;  ///< parents before children
    std::vector<SceneMesh> meshes;
    std::map<std::string, std::pair<int, std::size_t>> part_of_name;  ///< the node and its part of each aiNode's name
    const aiScene* source = nullptr;
    bool has_rest_weights = true;  ///< whether the file's format tells the weights of morph targets at rest
    std::vector<std::string> warnings;
};

/// Reads the hierarchy. Throws std::runtime_error if it is nested too deep, if a face names a vertex that its mesh
/// lacks, and if there are no faces.
Scene read_scene(const aiScene& source, bool has_rest_weights);

/// Returns the faces of a mesh with at least three corners, each in reverse order if they are `turned`.
std::vector<std::vector<std::uint32_t>> polygons_of(const aiMesh& mesh, bool turned);

/// Returns whether something in the file could move a mesh: a skin, a morph target, or an animation of a node that
/// carries a mesh.
bool has_motion(const Scene& scene);

/// Returns how far a morph target moves each vertex at weight one; empty if it does not fit the mesh.
std::vector<aiVector3D> target_offsets(const aiMesh& mesh, unsigned target);
/// Returns the weights of the morph targets of a mesh at rest.
std::vector<float> rest_weights(const Scene& scene, const aiMesh& mesh);

/// How a vertex follows a bone; `bone` is the index among those of the mesh.
struct Influence {
    unsigned bone = 0;
    float weight = 0;
};
/// Returns the positive weights of each vertex. A vertex without any follows the first bone.
std::vector<std::vector<Influence>> influences_of(const aiMesh& mesh);

/// Computes the vertices in the scene at rest: morphed, then moved by the joints or by the node.
std::vector<Position> positions_at_rest(const Scene& scene, const SceneMesh& placed);
/// Returns whether the transform at rest mirrors the mesh, which reverses its faces.
bool is_mirrored(const Scene& scene, const SceneMesh& placed);

}  // namespace exemplar::import
